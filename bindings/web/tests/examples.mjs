// Burns every example natively and again in WebAssembly: node examples.mjs PROGRAM REPLAYER FOLDER [EXAMPLE...]
//
// PROGRAM is a `singe` with SINGE_PORTABLE_MATH. It records the first 48 frames of each scene, with at most CELLS cells in
// a grid and coarse gas; meshes are as they are. REPLAYER is tests/platforms/hash_runs.c with the core compiled as for singe.wasm, but
// with recordings: it makes the same calls in node and compares the state after every step (docs/replay.md). Prints a
// table; fails where a state differs, or where a damaged recording passes.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";

const FRAMES = 48, CELLS = 300, GAS = "gas.cell_size=12 mm";
const EXAMPLES = new URL("../../../examples/", import.meta.url).pathname;
const [program, replayer, out, ...wanted] = process.argv.slice(2), folder = resolve(out); // WASI knows no current folder
mkdirSync(folder, { recursive: true });

/** Settings that make each grid of a scene coarse, in the order of its sheets. */
function coarse(text) {
    const sheets = text.slice(text.indexOf("\nsheets:")).split(/\n(?=[a-z])/)[1] ?? "";
    return sheets.split(/\n {2}- /).slice(1).flatMap((sheet, i) => {
        const [, across, along] = sheet.match(/cells: \[(\d+), (\d+)\]/)?.map(Number) ?? [], share = Math.sqrt(CELLS / (across * along));
        return share < 1 ? ["--set", `sheets.${i}.grid.cells=[${Math.round(share * across)}, ${Math.round(share * along)}]`] : [];
    });
}

/** What the replay of a recording says: one line. A process of its own, as node 20 may lose objects while WASI runs. */
function replayed(path) {
    const { stdout, stderr } = spawnSync(process.execPath, ["--no-warnings", "--input-type=module", "--eval", `
        import { readFileSync } from "node:fs";
        import { WASI } from "node:wasi";
        const wasi = new WASI({ version: "preview1", args: ["hash_runs", "--replay", process.argv[2]], preopens: { "/": "/" }, returnOnExit: false });
        wasi.start(await WebAssembly.instantiate(await WebAssembly.compile(readFileSync(process.argv[1])), wasi.getImportObject()));`,
        replayer, path], { encoding: "utf8" });
    return (stdout || stderr).trim().split("\n")[0];
}

/** Where the hash of the last state is: records are a kind (1 byte), a size (8) and that (docs/replay.md). */
function lastHash(bytes) {
    let found = 0;
    for (let at = 32; at + 9 <= bytes.length; at += 9 + Number(bytes.readBigUInt64LE(at + 1)))
        if (bytes[at] === 5) found = at + 9 + 8;
    return found;
}

let failures = 0, tried = 0;
console.log("example           springs  burnt   native  replayed in WebAssembly");
for (const name of readdirSync(EXAMPLES).filter((one) => !wanted.length || wanted.includes(one))) {
    const scene = `${EXAMPLES}${name}/${name}.yaml`, recording = `${folder}/${name}.singerec`, begun = Date.now();
    execFileSync(program, ["run", scene, "-o", `${folder}/${name}`, "--force", "--quiet", "--no-preview", "--threads", "1", "--frames", String(FRAMES),
        "--record", recording, "--set", GAS, ...coarse(readFileSync(scene, "utf8"))], { stdio: ["ignore", "ignore", "inherit"] });
    const [heads, ...rows] = readFileSync(`${folder}/${name}/stats.csv`, "utf8").trim().split("\n").map((line) => line.split(","));
    const of = (key, row) => Number(rows.at(row)[heads.indexOf(key)]), burnt = of("burnt_fraction", -1), native = (Date.now() - begun) / 1000;
    const said = replayed(recording), same = said.startsWith("the same: "), seconds = (Date.now() - begun) / 1000 - native;
    console.log(`${name.padEnd(16)} ${String(of("springs", 0)).padStart(8)} ${(100 * burnt).toFixed(2).padStart(5)} % ${native.toFixed(1).padStart(6)} s ${seconds.toFixed(1).padStart(6)} s  ${said}`);
    if (!same) failures++;
    tried++;
    if (tried > 1) continue;

    const bytes = readFileSync(recording), damaged = `${folder}/damaged.singerec`;
    bytes[lastHash(bytes)] ^= 1;
    writeFileSync(damaged, bytes);
    const other = replayed(damaged);
    if (other.startsWith("the same: ")) { failures++; console.log(`a damaged recording passes: ${other}`); }
}
console.log(failures || !tried ? `${failures} of ${tried} differ` : `all ${tried} examples have the native states`);
process.exitCode = failures || !tried ? 1 : 0;
