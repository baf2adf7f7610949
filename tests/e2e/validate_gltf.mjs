// Looks at .glb files with the Khronos validator:  node validate_gltf.mjs FILE|FOLDER…
// A line for each error and warning; exit code 1 if there was any, or nothing to look at. `./dev` installs the validator.
import { readFile, readdir, stat } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const SEVERITIES = ['error', 'warning'];

/** @param {string} path  @returns {Promise<string[]>} */
async function files(path) {
  if (!(await stat(path)).isDirectory()) return [path];
  return (await readdir(path)).filter((name) => name.endsWith('.glb')).sort().map((name) => join(path, name));
}

const validator = createRequire(new URL('../web/package.json', import.meta.url))('gltf-validator');
let looked = 0;
let found = 0;
for (const path of process.argv.slice(2)) {
  for (const file of await files(path)) {
    const report = await validator.validateBytes(new Uint8Array(await readFile(file)), { uri: file, maxIssues: 100 });
    looked += 1;
    for (const { severity, code, message, pointer } of report.issues.messages) {
      if (severity >= SEVERITIES.length) continue;
      found += 1;
      console.log(`${file}: ${SEVERITIES[severity]} ${code} at ${pointer ?? '/'}: ${message}`);
    }
  }
}
console.log(`${looked} file(s), ${found} error(s) and warning(s)`);
process.exitCode = looked === 0 || found > 0 ? 1 : 0;
