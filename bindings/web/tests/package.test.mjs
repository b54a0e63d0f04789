// The npm package in node: npm run build && npm test. SINGE_NATIVE names the native hash_runs of the preset "portable".
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { load, loadFiles, SingeError } from "../dist/index.js";

const MODULE_BYTES_MAX = 200_000; // gzipped

const bytes = await readFile(new URL("../dist/singe.wasm", import.meta.url)), singe = await load(bytes);

const CELLS = 24, SIDE = 0.15, CORNERS = CELLS + 1;

/** The run "burn" of tests/platforms/hash_runs.c. */
function burnAsInC() {
    const sim = singe.create({ pace: 30, contact: { enabled: true }, wind: { velocity: [0, 1, 0], gust: 0.5 } });
    const positions = [], cells = [], uv = [], f = Math.fround;
    for (let y = 0; y < CORNERS; y++)
        for (let x = 0; x < CORNERS; x++) {
            const u = f(x / CELLS), v = f(y / CELLS), corner = y * CORNERS + x;
            positions.push(f(f(SIDE) * f(u - 0.5)), f(f(SIDE) * f(v - 0.5)), 0);
            uv.push(u, v);
            if (x < CELLS && y < CELLS) cells.push(corner, corner + 1, corner + 1 + CORNERS, corner + CORNERS);
        }
    const sheet = sim.addSheet({ positions, cells, uv });
    sim.commit();
    const match = { time: 0, position: [f(f(SIDE) / 2), 0, 0] };
    sim.addSource({ kind: "spot", path: [match], radius: 0.01, falloff: 0.01, temperature: 1123, end: 0.5 });
    sim.addPin({ sheet, vertices: [0, CORNERS - 1] });
    return sim;
}

const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
const wrap = (number) => BigInt.asUintN(64, number);

/** hash_view of hash_runs.c. */
function hashView({ position, velocity, temperature, mass, particle_flags }) {
    const parts = [position, velocity, temperature, mass, particle_flags].map((array) =>
        bytesOf(array).reduce((hash, byte) => wrap((hash ^ BigInt(byte)) * 0x100000001b3n), 0xcbf29ce484222325n));
    return parts.reduce((hash, part) => wrap(hash * 31n + part)).toString(16).padStart(16, "0");
}

test("a burn has the bytes of the native library", { skip: !process.env.SINGE_NATIVE && "SINGE_NATIVE is not set" }, () => {
    const lines = execFileSync(process.env.SINGE_NATIVE, ["--instructions", "v2"], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
    const sim = burnAsInC();
    for (const step of [120, 240, 360, 480]) {
        while (sim.view().step < step) sim.step();
        const [, native] = lines.match(new RegExp(`^burn ${step} (\\w+)$`, "m"));
        assert.equal(hashView(sim.view()), native, `step ${step}`);
    }
    sim.destroy();
});

test("a saved simulation goes on with the same bytes", () => {
    const sim = burnAsInC();
    sim.advance(0.1);
    const again = singe.restore(sim.save());
    sim.advance(0.1);
    again.advance(0.1);
    assert.equal(hashView(again.view()), hashView(sim.view()));
    assert.ok(sim.stats().burnt_fraction > 0.01);
    sim.destroy();
    again.destroy();
});

test("what burns is drawn with a hole, and tells of it", () => {
    const sim = burnAsInC(), before = sim.draw().triangle_count;
    let opened = 0;
    for (let frame = 0; frame < 20; frame++) {
        sim.advance(1 / 24);
        opened += sim.events().filter((event) => event.kind === "hole").length;
    }
    const surface = sim.draw();
    assert.ok(opened > 0);
    assert.notEqual(surface.triangle_count, before);
    assert.equal(surface.position.length, 3 * surface.vertex_count);
    assert.ok(Math.max(...surface.triangles) < surface.vertex_count);
    sim.destroy();
});

test("the gas burns above the sheet", () => {
    const sim = singe.create({ pace: 30, gas: { enabled: true } });
    sim.addSheet({ size: [0.1, 0.1], cells: [12, 12] }, { base: "newsprint" });
    sim.commit();
    sim.addSource({ position: [0, 0, 0], radius: 0.02 });
    sim.advance(0.3);
    const gas = sim.gas();
    assert.equal(gas.flame.length, gas.size[0] * gas.size[1] * gas.size[2]);
    assert.ok(gas.flame.some((power) => power > 0));
    sim.destroy();
});

test("the module is small", () => {
    const size = gzipSync(bytes, { level: 9 }).length;
    assert.ok(size <= MODULE_BYTES_MAX, `${size} bytes gzipped; without wasm-opt (Debian: binaryen) it is larger`);
});

test("a wrong option is refused by name", () => {
    assert.throws(() => singe.create({ paces: 2 }), /sim has no paces/);
    assert.throws(() => singe.create({ pace: -1 }), (error) => error instanceof SingeError && /pace must be/.test(error.message));
    assert.throws(() => singe.create({ solver: { method: "glue" } }), /strand, paper/);
    const sim = singe.create();
    assert.throws(() => sim.addSheet({ size: [1, 1], cells: [4, 4] }, { base: "stone" }), /there are: cotton/);
    assert.throws(() => sim.step(), /commit/);
    sim.destroy();
});

test("cells that are no sheet are refused with the one that is wrong", () => {
    const sim = singe.create();
    assert.throws(() => sim.addSheet({ positions: [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], cells: [0, 1, 2, 7] }), SingeError);
    sim.destroy();
});

test("memory does not grow from one simulation to the next", () => {
    const burn = () => { const sim = burnAsInC(); sim.advance(0.05); sim.draw(); sim.save(); sim.destroy(); };
    burn();
    burn();
    const before = singe.memory.memory.buffer.byteLength;
    for (let i = 0; i < 20; i++) burn();
    assert.equal(singe.memory.memory.buffer.byteLength, before);
});

test("files are read and written as the command does", async () => {
    const files = await loadFiles(await readFile(new URL("../dist/singe-files.wasm", import.meta.url))), text = (words) => new TextEncoder().encode(words);
    const square = files.readMesh("square.obj", text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/2 4/1\n"));
    assert.deepEqual([...square.corners, ...square.sizes], [0, 1, 2, 3, 4]);
    assert.deepEqual([...square.corner_uv], [0, 0, 1, 1, 1, 1, 0, 0]);
    const quads = files.quads(square);
    assert.deepEqual([[...quads.positions], [...quads.cells]], [[0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], [0, 1, 2, 3]]);
    assert.equal(files.quads({ positions: square.positions, corners: [0, 1, 2, 0, 2, 3] }).cells.length, 4); // two triangles are a cell
    const wide = 60, many = { positions: [], corners: [] }; // more than the module's first pages
    for (let i = 0; i < (wide + 1) ** 2; i++) many.positions.push(i % (wide + 1), Math.floor(i / (wide + 1)), 0);
    for (let i = 0; i < wide ** 2; i++) { const v = (i % wide) + (wide + 1) * Math.floor(i / wide); many.corners.push(v, v + 1, v + wide + 2, v, v + wide + 2, v + wide + 1); }
    assert.equal(files.quads(many).cells.length, 4 * wide ** 2);
    assert.throws(() => files.quads({ positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], corners: [0, 1, 7] }), /vertex 7 of 3/);
    for (const [name, words, message] of [
        ["a.obj", "v 0 0 0\nf 1 1 7\n", "a.obj:2: corner 3 is out of range"], ["a.ply", "plx", "a.ply:1: not a PLY file"], ["a.glb", "glTF", "a.glb: not glTF"],
        ["a.stl", "solid\n", 'a.stl:2: "endsolid" is missing'], ["a.fbx", "", "a.fbx: the page reads OBJ"], ["a.txt", "", "a.txt: unknown mesh format"],
        ["a.gltf", '{"asset":{"version":"2.0"},"scenes":[{}],"buffers":[{"uri":"../b.bin","byteLength":4}]}', "a.gltf: "],
    ]) assert.throws(() => files.readMesh(name, text(words)), (error) => error.message.startsWith(message), name);

    const sim = burnAsInC();
    sim.advance(0.2);
    const usdc = files.writeUsdc(sim.draw(), "a sheet"), toc = new DataView(usdc.buffer).getBigUint64(16, true);
    assert.equal(new TextDecoder().decode(usdc.subarray(0, 8)), "PXR-USDC");
    assert.ok(usdc.length > 10_000 && toc < usdc.length);
    sim.destroy();
});
