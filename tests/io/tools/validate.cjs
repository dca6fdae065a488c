// Ask the Khronos validator about glTF files; prints one JSON report per file.
const fs = require('fs');
const path = require('path');
const validator = require('gltf-validator');

async function main() {
  const reports = [];
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
      uri: path.basename(file),
      maxIssues: 50,
      externalResourceFunction: async (uri) =>
        new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)))),
    });
    reports.push(report);
  }
  console.log(JSON.stringify(reports));
}

main();
