// Makes build/web/review.html from src/: one file with all code and style, and with the licences of the libraries.
import { build } from 'esbuild';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, renameSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const out = join(here, '..', 'build', 'web');
const MARK = '<!--spawnfield-data-->';
const LARGEST_SHELL = 1024 * 1024;
const LIBRARIES = { three: 'LICENSE', 'three-mesh-bvh': 'LICENSE', fflate: 'LICENSE', meshoptimizer: 'LICENSE.md' };

const licences = {
  name: 'licences',
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /^licences$/ }, ({ path }) => ({ path, namespace: 'licences' }));
    onLoad({ filter: /.*/, namespace: 'licences' }, () => ({
      loader: 'json',
      contents: JSON.stringify(
        Object.entries(LIBRARIES).map(([name, file]) => {
          const folder = join(here, 'node_modules', name);
          const { version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
          return [`${name} ${version}`, readFileSync(join(folder, file), 'utf8').trim()];
        }),
      ),
    }));
  },
};

const common = {
  bundle: true,
  minify: true,
  write: false,
  legalComments: 'inline',
  logLevel: 'warning',
  absWorkingDir: here,
};
const [script] = (
  await build({
    ...common,
    entryPoints: ['src/main.js'],
    format: 'iife',
    target: 'es2022',
    charset: 'utf8',
    plugins: [licences],
  })
).outputFiles;
const [style] = (await build({ ...common, entryPoints: ['src/review.css'] })).outputFiles;
// Without these texts, a browser reads the whole script as one element.
const code = script.text.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--').trim();
const html = readFileSync(join(here, 'src/shell.html'), 'utf8')
  .replace('/*STYLE*/', () => style.text.trim())
  // No other script may run, also if a name in the page were not escaped.
  .replace('/*HASH*/', () => `'sha256-${createHash('sha256').update(code).digest('base64')}'`)
  .replace('/*SCRIPT*/', () => code);

const lines = html.split('\n').filter((line) => line === MARK).length;
if (lines !== 1 || html.split(MARK).length !== 2)
  throw new Error(`build.mjs: the page has the mark ${MARK} not exactly once`);
if (Buffer.byteLength(html) > LARGEST_SHELL)
  throw new Error(`build.mjs: the page has ${Buffer.byteLength(html)} bytes, the limit is ${LARGEST_SHELL}`);
mkdirSync(out, { recursive: true });
const half = join(out, `review.html.${process.pid}`);
writeFileSync(half, html);
renameSync(half, join(out, 'review.html'));
console.log(`build/web/review.html has ${Buffer.byteLength(html)} bytes`);
