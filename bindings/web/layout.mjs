// Runs layout.c, which prints src/layout.ts: node layout.mjs PROGRAM.wasm
import { closeSync, openSync, readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const out = openSync(new URL("src/layout.ts", import.meta.url), "w"), wasi = new WASI({ version: "preview1", stdout: out });
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), wasi.getImportObject());
if (wasi.start(instance)) throw new Error("the layout was not printed");
closeSync(out);
