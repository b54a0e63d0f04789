// Bundles the page into dist: node build.mjs. The npm package and singe.wasm must be built (make web).
import { build } from "esbuild";
import { cp, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";

const here = new URL(".", import.meta.url).pathname;
await rm(`${here}dist`, { recursive: true, force: true });
await mkdir(`${here}dist`);
await build({
    absWorkingDir: here, entryPoints: ["src/main.ts", "src/worker.ts", "src/how.ts"], outdir: "dist", bundle: true, minify: true, format: "esm",
    target: "es2022", alias: { singe: "../bindings/web/src/index.ts" }, logLevel: "warning", legalComments: "none",
});
for (const name of ["singe.wasm", "singe-files.wasm"]) await cp(`${here}../bindings/web/dist/${name}`, `${here}dist/${name}`);
for (const name of ["letter/letter.png", "curtain/curtain.jpg", "newspaper/newspaper.jpg", "title/title.png"])
    await cp(`${here}../examples/${name}`, `${here}dist/${name.split("/")[1]}`);
for (const name of ["index.html", "style.css", "how.html", "how.css"]) await cp(here + name, `${here}dist/${name}`);

// what a visitor loads, but for the scenes' pictures
let total = 0, core = 0;
for (const name of ["index.html", "style.css", "main.js", "worker.js", "singe.wasm"]) {
    const bytes = await readFile(`${here}dist/${name}`), size = gzipSync(bytes, { level: 9 }).length;
    total += size;
    if (name === "singe.wasm") core = size;
    console.log(`${name.padEnd(12)} ${String(bytes.length).padStart(8)} bytes ${String(size).padStart(8)} gzipped`);
}
console.log(`${"in all".padEnd(12)} ${" ".repeat(14)} ${String(total).padStart(8)} gzipped`);
await writeFile(`${here}dist/size.txt`, `${core} ${total}\n`);
