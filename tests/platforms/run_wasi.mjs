// Runs a program for WASI with node, as an emulator does: run_wasi.mjs PROGRAM [ARGUMENT...]. It may open all files.
import { readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const arguments_ = process.argv.slice(2);
const wasi = new WASI({ version: "preview1", args: arguments_, preopens: { "/": "/" }, returnOnExit: true });
const module_ = await WebAssembly.compile(readFileSync(arguments_[0]));
const instance = await WebAssembly.instantiate(module_, wasi.getImportObject());
process.exitCode = wasi.start(instance);
