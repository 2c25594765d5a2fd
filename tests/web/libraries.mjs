// The libraries of web/node_modules, which tests outside of web/ cannot import by name.
import { createRequire } from 'node:module';

const require = createRequire(new URL('../../web/package.json', import.meta.url));
export const { zlibSync } = require('fflate');
export const MeshoptEncoder = require('meshoptimizer/meshopt_encoder.js');
export const esbuild = require('esbuild');
export const { chromium } = require('playwright-core');
