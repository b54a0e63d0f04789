// An editor's language server (yaml-language-server, as in VS Code, Neovim, Emacs, ...) with the schema of scenes: it finds
// nothing in the letter, each fault of a broken scene, and completes a key.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const ROOT = new URL("../../", import.meta.url).pathname, SINGE = process.env.SINGE ?? `${ROOT}build/singe`;
const work = await mkdtemp(join(tmpdir(), "singe-editor-")), schema = pathToFileURL(join(work, "singe.schema.json")).href;
await writeFile(join(work, "singe.schema.json"), execFileSync(SINGE, ["scene-schema"]));

const server = spawn(process.execPath, ["node_modules/yaml-language-server/bin/yaml-language-server", "--stdio"],
    { cwd: `${ROOT}web`, stdio: ["pipe", "pipe", "inherit"] });
const answers = new Map(), problems = new Map();
let asked = 0, came = Buffer.alloc(0);
const send = (message) => {
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    server.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
};
const ask = (method, params) => new Promise((resolve) => {
    answers.set(++asked, resolve);
    send({ id: asked, method, params });
});
function take(message) {
    if (message.method === "workspace/configuration") {
        const yaml = { validate: true, completion: true, schemaStore: { enable: false } };
        send({ id: message.id, result: message.params.items.map(({ section }) => (section === "yaml" ? yaml : null)) });
    } else if (message.method === "textDocument/publishDiagnostics") {
        problems.get(message.params.uri)?.(message.params.diagnostics);
    } else if (message.method && message.id !== undefined) send({ id: message.id, result: null });
    else answers.get(message.id)?.(message.result);
}
server.stdout.on("data", (bytes) => {
    came = Buffer.concat([came, bytes]);
    for (let head; (head = came.indexOf("\r\n\r\n")) >= 0;) {
        const end = head + 4 + Number(/Content-Length: (\d+)/i.exec(came.subarray(0, head))[1]);
        if (came.length < end) return;
        const message = JSON.parse(came.subarray(head + 4, end));
        came = came.subarray(end);
        take(message);
    }
});

/** Opens a text under the line that names the schema, and returns its address and what the server finds, by line. */
async function open(name, text) {
    const uri = pathToFileURL(join(work, name)).href, found = new Promise((resolve) => problems.set(uri, resolve));
    const whole = `# yaml-language-server: $schema=${schema}\n${text}`;
    send({ method: "textDocument/didOpen", params: { textDocument: { uri, languageId: "yaml", version: 1, text: whole } } });
    return { uri, found: (await found).map(({ range, message }) => [range.start.line, message]).sort(([a], [b]) => a - b) };
}

const limit = setTimeout(() => { throw new Error("the language server does not answer"); }, 60_000);
await ask("initialize", { processId: process.pid, rootUri: pathToFileURL(work).href, capabilities: { workspace: { configuration: true } } });
send({ method: "initialized", params: {} });
const letter = await open("letter.yaml", await readFile(`${ROOT}examples/letter/letter.yaml`, "utf8"));
assert.deepEqual(letter.found, []);
const broken = await open("broken.yaml", `frames: 24
pacce: 3
sheets:
  - grid: {size: [21 cm, 29 cm], cells: [60, 84]}
    material: {base: office-paper, grammage: 80 mm}
sources:
  - {kind: spott, position: [0, 0, 0]}
gas: perhaps
`);
assert.deepEqual(broken.found.map(([line]) => line), [2, 5, 7, 8]);
assert.match(broken.found[0][1], /pacce is not allowed/);
assert.match(broken.found[2][1], /"spot"/);
const typing = await open("typing.yaml", "frames: 24\nsources:\n  - kind: spot\n    te\n");
const { items } = await ask("textDocument/completion", { textDocument: { uri: typing.uri }, position: { line: 4, character: 6 } });
assert.ok(items.some(({ label }) => label === "temperature"));
console.log(`editor: nothing in the letter, ${broken.found.length} faults of 4 in a broken scene, ${items.length} keys offered`);
clearTimeout(limit);
server.kill();
await rm(work, { recursive: true });
