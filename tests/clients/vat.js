// Vertex animation textures of a burn by Singe, drawn by three.js in a browser (vat.html): every vertex of some frames, as
// the vertex shader finds it, against the cache, bit for bit; and pictures to look at.
//
// usage: node vat.js SINGE FOLDER CHROMIUM    FOLDER is emptied, picture.NNNN.png are in it; NODE_PATH has three
'use strict';
const fs = require('fs'), http = require('http'), path = require('path'), {execFileSync, spawn} = require('child_process');

const [singe, folder, chromium] = process.argv.slice(2);
const three = path.join(process.env.NODE_PATH, 'three'), FRAMES = [1, 10, 20, 24];
fs.rmSync(folder, {recursive: true, force: true});
const make = `import sys; sys.path.insert(0, ${JSON.stringify(__dirname)}); import burn; print(burn.make(sys.argv[1], ` +
    `sys.argv[2], ["textures"], "--no-preview", "--set", "gas=no", "--set", "output.texture_size=512"))`;
const out = execFileSync(process.env.PYTHON || 'python3', ['-c', make, singe, folder]).toString().trim();
execFileSync(singe, ['convert', out, '--to', 'vat', '--quiet']);

/// Vertices of the mesh that the cache still has: number -> position in the axes of glTF.
function readCache(frame) {
    const bytes = fs.readFileSync(path.join(out, 'ply', `burn.${String(frame).padStart(4, '0')}.ply`));
    const end = bytes.indexOf('end_header\n') + 11, header = bytes.subarray(0, end).toString();
    const names = [...header.matchAll(/property (?:float|int) (\w+)/g)].map(match => match[1]);
    const at = (row, name) => end + 4 * (row * names.length + names.indexOf(name));
    const there = new Map();
    for (let row = 0; row < Number(/element vertex (\d+)/.exec(header)[1]); row++) {
        const number = bytes.readInt32LE(at(row, 'vertex_id'));
        const [x, y, z] = ['x', 'y', 'z'].map(name => bytes.readFloatLE(at(row, name)));
        if (number >= 0) there.set(number, [x, z, -y]);
    }
    return there;
}

function check(frame, body) {
    const info = JSON.parse(fs.readFileSync(path.join(out, 'vat', 'burn.json')));
    const found = new Float32Array(body.buffer.slice(body.byteOffset, body.byteOffset + body.length));
    const there = readCache(frame);
    let gone = 0;
    for (let i = 0; i < info.vertices; i++) {
        const here = found.subarray(4 * i, 4 * i + 4), want = there.get(i);
        if (here[3] !== (want ? 1 : 0)) throw new Error(`frame ${frame}, vertex ${i}: alpha ${here[3]}, in the cache: ${!!want}`);
        if (!want) gone++;
        else if (want.some((value, c) => !Object.is(Math.fround(value) + 0, here[c] + 0)))
            throw new Error(`frame ${frame}, vertex ${i}: ${here.slice(0, 3)}, the cache has ${want}`);
    }
    return {there: there.size, gone};
}

const kinds = {'.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json'};
const counts = {};
let browser;

function end(message, code) {
    console.log(message);
    if (browser) browser.kill();
    process.exit(code);
}

function take(url, body) {
    const [, what, frame] = url.split('/');
    if (what === 'found') counts[frame] = check(Number(frame), body);
    else if (what === 'picture') fs.writeFileSync(path.join(folder, `picture.${frame.padStart(4, '0')}.png`), body);
    else {
        const result = JSON.parse(body);
        if (result.error) end(result.error, 1);
        const told = FRAMES.map(f => `${f}: ${counts[f].there} there, ${counts[f].gone} gone`).join('; ');
        const burnt = counts[FRAMES[3]];
        if (counts[1].gone || !burnt.gone || !burnt.there) end(`not a burn: ${told}`, 1);
        end(`three.js ${result.version}: every vertex of the shader is the cache's in frames ${told}`, 0);
    }
}

function answer(request, response) {
    if (request.method === 'POST') {
        const parts = [];
        request.on('data', part => parts.push(part));
        request.on('end', () => {
            response.end();
            try {
                take(request.url, Buffer.concat(parts));
            } catch (error) {
                end(error.message, 1);
            }
        });
        return;
    }
    const url = new URL(request.url, 'http://localhost').pathname;
    const file = url === '/' ? path.join(__dirname, 'vat.html')
        : url.startsWith('/three/') ? path.join(three, url.slice(7)) : path.join(out, url.replace(/^\/out\//, ''));
    fs.readFile(file, (error, bytes) => {
        response.writeHead(error ? 404 : 200, {'Content-Type': kinds[path.extname(file)] || 'application/octet-stream'});
        response.end(error ? '' : bytes);
    });
}

setTimeout(() => end('the browser has not answered in four minutes', 1), 240000).unref();
const server = http.createServer(answer).listen(0, '127.0.0.1', () => {
    const url = `http://127.0.0.1:${server.address().port}/?name=burn&frames=${FRAMES.join(',')}`;
    browser = spawn(chromium, ['--headless=new', '--no-sandbox', '--no-first-run', '--use-gl=angle',
        '--use-angle=swiftshader', '--enable-unsafe-swiftshader', `--user-data-dir=${path.join(folder, 'browser')}`, url],
        {stdio: 'ignore'});
    browser.on('error', error => end(String(error), 1));
});
