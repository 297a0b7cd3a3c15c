// validate.mjs FILE...: runs the Khronos glTF validator (npm: gltf-validator) over .glb files. Exit code 0: no error and no
// warning; 1: some, listed; 77: the validator is not installed (point GLTF_VALIDATOR at its folder, or install it where
// node finds it).
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';

let validator;
try {
  const folder = process.env.GLTF_VALIDATOR;
  const require = createRequire(folder ? join(folder, 'x.js') : join(process.cwd(), 'x.js'));
  validator = require('gltf-validator');
} catch {
  console.log('gltf-validator is not installed: skipped');
  process.exit(77);
}

let failures = 0;
for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {maxIssues: 20});
  const {numErrors, numWarnings, numInfos, numHints, messages} = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} remarks, ${numHints} hints`);
  for (const m of messages) console.log(`  ${m.code} ${m.pointer ?? ''} ${m.message}`);
  if (numErrors + numWarnings > 0) ++failures;
}
process.exit(failures > 0 ? 1 : 0);
