// The libraries of web/node_modules, which tests outside of web/ cannot import by name.
import { createRequire } from 'node:module';

const require = createRequire(new URL('../../web/package.json', import.meta.url));
export const { zlibSync } = require('fflate');
export const { MeshoptEncoder } = await import(require.resolve('meshoptimizer/meshopt_encoder.module.js'));
export const { chromium } = require('playwright-core');
