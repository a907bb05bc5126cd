// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Prints the report of Khronos' glTF validator. Usage: node validate_glb.js FOLDER_OF_NODE_MODULES FILE
const fs = require('fs');
const path = require('path');
const validator = require(path.join(process.argv[2], 'node_modules', 'gltf-validator'));

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[3])))
    .then((report) => console.log(JSON.stringify(report)))
    .catch((fault) => { console.error(String(fault)); process.exitCode = 1; });
