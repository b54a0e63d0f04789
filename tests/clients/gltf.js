// GLB frames of a burn by Singe, looked at by the glTF validator (npm's gltf-validator): no errors, no warnings; and
// their values against those of the cache, by reading the file here.
//
// usage: node gltf.js SINGE FOLDER    FOLDER is emptied; NODE_PATH has gltf-validator and gltf-transform
'use strict';
const fs = require('fs'), path = require('path'), {execFileSync} = require('child_process');
const validator = require('gltf-validator');

const [singe, folder] = process.argv.slice(2);
fs.rmSync(folder, {recursive: true, force: true});
const make = `import sys; sys.path.insert(0, ${JSON.stringify(__dirname)}); import burn; print(burn.make(sys.argv[1], ` +
    `sys.argv[2], ["glb"], "--no-preview", "--set", "gas=no"))`;
const makeGone = make.replace('burn.make(', 'burn.make_gone(').replace(/\["glb"\].*$/, '["glb"]))');
const out = execFileSync(process.env.PYTHON || 'python3', ['-c', make, singe, folder]).toString().trim();

function readPly(file) {
    const bytes = fs.readFileSync(file), end = bytes.indexOf('end_header\n') + 11;
    const header = bytes.subarray(0, end).toString();
    const count = Number(/element vertex (\d+)/.exec(header)[1]);
    const columns = [...header.matchAll(/property (float|int) (\w+)/g)].map(match => [match[2], match[1]]);
    const frame = {count};
    columns.forEach(([name, kind], at) => {
        frame[name] = Array.from({length: count}, (_, i) => {
            const place = end + 4 * (i * columns.length + at);
            return kind === 'int' ? bytes.readInt32LE(place) : bytes.readFloatLE(place);
        });
    });
    return frame;
}

function readGlb(file) {
    const bytes = fs.readFileSync(file), size = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.subarray(20, 20 + size).toString()), data = bytes.subarray(28 + size);
    const accessor = index => {
        const a = json.accessors[index], begin = json.bufferViews[a.bufferView].byteOffset;
        const width = {SCALAR: 1, VEC2: 2, VEC3: 3}[a.type];
        return Array.from({length: a.count * width}, (_, i) => data.readFloatLE(begin + 4 * i));
    };
    return {json, accessor, data};
}

function check(frame) {
    const name = String(frame).padStart(4, '0');
    const {json, accessor} = readGlb(path.join(out, 'glb', `burn.${name}.glb`));
    const cache = readPly(path.join(out, 'ply', `burn.${name}.ply`));
    json.meshes.forEach((mesh, sheet) => {
        const rows = [...Array(cache.count).keys()].filter(i => cache.sheet[i] === sheet);
        const primitive = mesh.primitives[0], has = primitive.attributes;
        const expect = (attribute, values) => {
            const got = accessor(has[attribute]);
            if (got.length !== values.length || got.some((value, i) => !Object.is(value + 0, values[i] + 0)))
                throw new Error(`frame ${frame}, ${mesh.name}: ${attribute} differs`);
        };
        expect('POSITION', rows.flatMap(i => [cache.x[i], cache.z[i], -cache.y[i]]));
        expect('_VELOCITY', rows.flatMap(i => [cache.vx[i], cache.vz[i], -cache.vy[i]]));
        expect('_REST', rows.flatMap(i => [cache.rest_x[i], cache.rest_z[i], -cache.rest_y[i]]));
        for (const field of ['temperature', 'temperature_peak', 'mass', 'burn_rate', 'char_fraction', 'ash_fraction',
                             'burnt', 'time_ignited', 'piece_id', 'vertex_id', 'sheet'])
            expect('_' + field.toUpperCase(), rows.map(i => cache[field][i]));
    });
}

async function validate(file) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
        uri: path.basename(file),
        externalResourceFunction: uri => fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri)))
            .then(bytes => new Uint8Array(bytes)),
    });
    if (report.issues.numErrors || report.issues.numWarnings) {
        console.log(file, JSON.stringify(report.issues.messages.slice(0, 5), null, 1));
        process.exit(1);
    }
    return report.issues.numInfos + report.issues.numHints;
}

// The model of all frames: a mesh a sheet and frame, shown by its scale.
async function checkSingle() {
    execFileSync(singe, ['convert', out, '--to', 'vat', '--quiet']);
    execFileSync(singe, ['convert', out, '--to', 'glb', '--single', '--plain', '--quiet']);
    const single = path.join(folder, 'plain.glb');
    fs.renameSync(path.join(out, 'burn.glb'), single);
    const remarks = await validate(path.join(out, 'vat', 'burn.glb')) + await validate(single);
    const {json, accessor} = readGlb(single);
    if (json.images.length !== 1 || json.images[0].mimeType !== 'image/png') throw new Error('no picture inside');
    const channels = json.animations[0].channels;
    if (channels.length !== json.nodes.length || json.nodes.length < 24) throw new Error('channels');
    const cache = readPly(path.join(out, 'ply', 'burn.0001.ply')), first = json.meshes[0].primitives[0].attributes;
    const mine = [...Array(cache.count).keys()].filter(i => cache.sheet[i] === 0);
    if (accessor(first._TEMPERATURE).some((value, k) => value !== cache.temperature[mine[k]])) throw new Error('values');
    return remarks;
}

// The packed model, decoded by meshoptimizer's own decoder, against the plain one: each value of each corner.
const ERRORS = {POSITION: 2 ** -18, NORMAL: 0.02, TEXCOORD_0: 2 ** -14, COLOR_0: 2 ** -10, _VELOCITY: 2 ** -9, _TEMPERATURE: 0.5, _BURNT: 2 ** -11};
async function checkPacked() {
    const {MeshoptDecoder} = require('meshoptimizer'), worst = {};
    await MeshoptDecoder.ready;
    execFileSync(singe, ['convert', out, '--to', 'glb', '--single', '--quiet']);
    const file = path.join(out, 'burn.glb'), remarks = await validate(file);
    const plain = readGlb(path.join(folder, 'plain.glb')), bytes = fs.readFileSync(file), size = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.subarray(20, 20 + size).toString()), data = bytes.subarray(28 + size);
    if (!json.extensionsRequired) return 'this singe does not pack';
    const read = index => {
        const a = json.accessors[index], view = json.bufferViews[a.bufferView].extensions.EXT_meshopt_compression;
        const raw = new Uint8Array(view.count * view.byteStride), width = {SCALAR: 1, VEC2: 2, VEC3: 3}[a.type], values = [];
        MeshoptDecoder.decodeGltfBuffer(raw, view.count, view.byteStride, data.subarray(view.byteOffset, view.byteOffset + view.byteLength), view.mode, view.filter);
        const from = new DataView(raw.buffer), kind = {5120: ['getInt8', 1, 127], 5123: ['getUint16', 2, 65535], 5125: ['getUint32', 4, 1], 5126: ['getFloat32', 4, 1]}[a.componentType];
        for (let i = 0; i < a.count; i++) for (let c = 0; c < width; c++) values.push(from[kind[0]](i * view.byteStride + c * kind[1], true) / kind[2]);
        return {values, width};
    };
    plain.json.meshes.forEach((mesh, m) => {
        const before = mesh.primitives[0], after = json.meshes[m].primitives[0], corners = read(after.indices).values;
        const a = plain.json.accessors[before.indices], view = plain.json.bufferViews[a.bufferView];
        const was = Array.from({length: a.count}, (_, i) => plain.data.readUInt32LE(view.byteOffset + 4 * i));
        if (corners.length !== was.length) throw new Error('corners');
        if (Object.keys(before.attributes).join() !== Object.keys(after.attributes).join()) throw new Error('attributes');
        const old = {}, now = {};
        for (const name of Object.keys(ERRORS)) old[name] = plain.accessor(before.attributes[name]), now[name] = read(after.attributes[name]);
        // the largest error of a plain triangle u against a packed one t that begins at another of its corners
        const far = (name, t, u, turn) => {
            const {values, width} = now[name];
            let most = 0;
            for (let k = 0; k < 3; k++) for (let c = 0; c < width; c++)
                most = Math.max(most, Math.abs(values[corners[3 * t + (k + turn) % 3] * width + c] - old[name][was[3 * u + k] * width + c]));
            return most;
        };
        // packed triangles have an order of their own: each is the plain one, used once, that is nearest in space and on the sheet
        const cellsOf = (points, triangle) => [0, 1, 2].map(c => Math.floor(2 ** 10 * triangle.reduce((sum, v) => sum + points[3 * v + c], 0)));
        const there = new Map();
        for (let u = 0; 3 * u < was.length; u++) {
            const key = cellsOf(old.POSITION, was.slice(3 * u, 3 * u + 3)).join();
            if (!there.has(key)) there.set(key, new Set());
            there.get(key).add(u);
        }
        for (let t = 0; 3 * t < was.length; t++) {
            const [x, y, z] = cellsOf(now.POSITION.values, corners.slice(3 * t, 3 * t + 3));
            let best = null;
            for (let n = 0; n < 27; n++) {
                const home = there.get([x + n % 3 - 1, y + Math.floor(n / 3) % 3 - 1, z + Math.floor(n / 9) - 1].join());
                for (const u of home ?? []) for (let turn = 0; turn < 3; turn++) {
                    const off = far('POSITION', t, u, turn) + far('TEXCOORD_0', t, u, turn);
                    if (!best || off < best.off) best = {off, u, turn, home};
                }
            }
            if (!best) throw new Error('a packed triangle is none of the plain ones');
            best.home.delete(best.u);
            for (const name of Object.keys(ERRORS)) worst[name] = Math.max(worst[name] || 0, far(name, t, best.u, best.turn));
        }
    });
    for (const [name, bound] of Object.entries(ERRORS))
        if (!(worst[name] <= bound * 1.0001)) throw new Error(`${name} is off by ${worst[name]}, more than ${bound}`);
    const share = bytes.length / fs.statSync(path.join(folder, 'plain.glb')).size;
    if (share > 0.25) throw new Error(`the packed model has ${share} of the plain one's bytes`);
    const list = Object.entries(worst).map(([name, value]) => `${name} ${value.toPrecision(2)}`).join(', ');
    return `the packed model: ${bytes.length} bytes, ${(100 * share).toFixed(0)} % of the plain one, ${remarks} remarks; largest errors ${list}`;
}

// gltf-transform's meshopt keeps every attribute; values within -1 to 1 are rounded to 12 bits.
async function checkMeshopt() {
    const {Logger, NodeIO} = require('@gltf-transform/core'), {ALL_EXTENSIONS} = require('@gltf-transform/extensions');
    const {meshopt} = require('@gltf-transform/functions');
    const {MeshoptDecoder, MeshoptEncoder} = require('meshoptimizer');
    await MeshoptEncoder.ready, await MeshoptDecoder.ready;
    const io = new NodeIO().registerExtensions(ALL_EXTENSIONS)
        .registerDependencies({'meshopt.decoder': MeshoptDecoder, 'meshopt.encoder': MeshoptEncoder});
    const file = path.join(out, 'glb', 'burn.0018.glb'), packed = path.join(folder, 'packed.glb');
    const ranges = document => document.getRoot().listMeshes().map(mesh => {
        const primitive = mesh.listPrimitives()[0];
        return Object.fromEntries(primitive.listSemantics().map(semantic => {
            const accessor = primitive.getAttribute(semantic);
            return [semantic, [accessor.getMinNormalized([])[0], accessor.getMaxNormalized([])[0]]];
        }));
    });
    const document = (await io.read(file)).setLogger(new Logger(Logger.Verbosity.SILENT)), before = ranges(document);
    await document.transform(meshopt({encoder: MeshoptEncoder, level: 'medium'}));
    await io.write(packed, document);
    const after = ranges(await io.read(packed));
    before.forEach((mesh, i) => {
        for (const name of Object.keys(mesh)) {
            if (!after[i][name]) throw new Error(`meshopt drops ${name}`);
            if (name === '_TEMPERATURE' || name === '_BURNT' || name === '_VELOCITY')
                mesh[name].forEach((bound, k) => {
                    if (Math.abs(bound - after[i][name][k]) > 5e-4 * Math.max(1, ...mesh[name].map(Math.abs)))
                        throw new Error(`meshopt changes ${name}: ${mesh[name]} to ${after[i][name]}`);
                });
        }
    });
    return `gltf-transform's meshopt: ${fs.statSync(packed).size} bytes of ${fs.statSync(file).size}, all ` +
        `${Object.keys(after[0]).length} attributes`;
}

(async () => {
    const files = fs.readdirSync(path.join(out, 'glb')).sort();
    let hints = 0;
    for (const file of files) hints += await validate(path.join(out, 'glb', file));
    hints += await checkSingle();
    const gone = execFileSync(process.env.PYTHON || 'python3', ['-c', makeGone, singe, folder]).toString().trim();
    const nodes = [];
    for (const file of fs.readdirSync(path.join(gone, 'glb')).sort()) {
        await validate(path.join(gone, 'glb', file));
        nodes.push((readGlb(path.join(gone, 'glb', file)).json.nodes || []).length);
    }
    if (nodes.length !== 12 || !nodes[0] || nodes[11]) throw new Error(`a sheet that burns away has nodes ${nodes}`);
    console.log(await checkPacked());
    console.log(await checkMeshopt());
    const frames = [1, 10, 20, 24];
    frames.forEach(check);
    console.log(`gltf-validator ${validator.version()}: ${files.length} frames, the model of all and that of the VAT without ` +
        `errors or warnings (${hints} remarks); every value of frames ${frames}`);
})().catch(error => { console.log(error); process.exit(1); });
