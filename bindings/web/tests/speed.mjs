// Steps a second of a burning sheet of 25,000 springs, and the size of the module: node tests/speed.mjs [WASM]
import { readFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";
import { load } from "../dist/index.js";

const bytes = await readFile(process.argv[2] ?? new URL("../dist/singe.wasm", import.meta.url));
const singe = await load(bytes), STEPS = 480;

/** ms of processor time a step. */
function measure(options) {
    const sim = singe.create({ pace: 6, ...options });
    sim.addSheet({ size: [0.25, 0.25], cells: [50, 50] }, { base: "office-paper" });
    sim.addCollider({ kind: "plane", position: [0, 0, -0.001] });
    sim.commit();
    sim.addSource({ position: [0, 0, 0], radius: 0.02, end: 1 });
    const springs = sim.view().spring_count.reduce((a, b) => a + b);
    sim.advance(0.25);
    const before = process.cpuUsage();
    for (let i = 0; i < STEPS; i++) sim.step();
    const spent = process.cpuUsage(before).user / 1000 / STEPS;
    sim.destroy();
    return [springs, spent];
}

console.log(`singe.wasm: ${bytes.length} bytes, ${gzipSync(bytes, { level: 9 }).length} gzipped`);
for (const [name, options] of [["sheet alone", {}], ["with gas", { gas: { enabled: true } }], ["plain loops", { instructions: "plain" }]]) {
    const [springs, spent] = measure(options);
    console.log(`${name}: ${springs} springs, ${spent.toFixed(2)} ms of processor time a step, ${(1000 / spent).toFixed(0)} steps/s`);
}
