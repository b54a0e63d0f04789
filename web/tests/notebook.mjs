// The notebook's widget in Chromium: a Python with anywidget holds the widget, as a kernel does, and this is the notebook.
//
// usage: node notebook.mjs PYTHON FOLDER_OF_A_RUN [PICTURE.png]     PYTHON imports singe, anywidget and numpy
import { spawn } from "node:child_process";
import { createServer } from "node:http";
import { createInterface } from "node:readline";
import { chromium } from "playwright-core";
import { CHROMIUM, CHROMIUM_ARGS } from "./browsers.mjs";

const KERNEL = `
import base64, json, sys
import singe
widget = singe.view(singe.read_cache(sys.argv[1]), height=520)
def send(content, buffers):
    print(json.dumps([content, [base64.b64encode(one).decode() for one in buffers]]), flush=True)
widget.send = send
print(json.dumps(widget._esm), flush=True)
for line in sys.stdin:
    widget._handle_custom_msg(json.loads(line), [])
widget.close()
`;
const [, , python, folder, picture] = process.argv;
const kernel = spawn(python, ["-c", KERNEL, folder], { stdio: ["pipe", "pipe", "inherit"] });
const lines = createInterface({ input: kernel.stdout })[Symbol.asyncIterator]();
const esm = JSON.parse((await lines.next()).value);

const server = createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end("<!doctype html><div id=cell></div>"));
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const browser = await chromium.launch({ executablePath: CHROMIUM, args: CHROMIUM_ARGS });
let bad = 0;
const check = (what, good) => {
    console.log(`${good ? "ok  " : "BAD "} ${what}`);
    bad += !good;
};
try {
    const page = await browser.newPage({ viewport: { width: 900, height: 600 } }), errors = [];
    page.on("pageerror", (error) => errors.push(error.message));
    page.on("requestfailed", (request) => errors.push(request.url()));
    const outside = [];
    page.on("request", (request) => /^https?:/.test(request.url()) && outside.push(request.url()));
    await page.exposeFunction("toKernel", (message) => void kernel.stdin.write(`${JSON.stringify(message)}\n`));
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    (async () => {
        for await (const line of lines) await page.evaluate(([content, buffers]) => window.fromKernel(content, buffers), JSON.parse(line)).catch(() => {});
    })();
    await page.evaluate(async (code) => {
        const { default: widget } = await import(URL.createObjectURL(new Blob([code], { type: "text/javascript" })));
        const listeners = new Set();
        window.fromKernel = (content, buffers) => {
            const bytes = buffers.map((one) => new DataView(Uint8Array.from(atob(one), (c) => c.charCodeAt(0)).buffer));
            for (const listener of listeners) listener(content, bytes);
        };
        const model = { get: () => 520, send: window.toKernel, on: (_, f) => listeners.add(f), off: (_, f) => listeners.delete(f) };
        window.leave = widget.render({ model, el: document.getElementById("cell") });
        window.listening = () => listeners.size;
    }, esm);
    const inside = async (call) => page.frames()[1]?.evaluate(call).catch(() => null);
    const until = async (call) => {
        for (const end = Date.now() + 60_000; Date.now() < end; await page.waitForTimeout(100)) {
            const value = await inside(call);
            if (value) return value;
        }
        return null;
    };
    check("the burn is drawn", await until(() => document.getElementById("view").classList.contains("ready")));
    check("it has all frames", (await until(() => document.getElementById("time").max)) > 1);
    await inside(() => {
        const time = document.getElementById("time");
        time.value = time.max;
        time.dispatchEvent(new Event("input", { bubbles: true }));
    });
    check("the last frame is shown", await until(() => document.getElementById("at").textContent.includes(document.getElementById("time").max)));
    await inside(() => document.querySelector('[data-layer="temperature"]').click());
    check("layers switch", await until(() => !document.getElementById("legend").hidden));
    await inside(() => document.querySelector('[data-layer="paper"]').click());
    await page.waitForTimeout(500);
    if (picture) await page.screenshot({ path: picture });
    check("the browser asks nobody but the notebook", outside.length === 1);
    const refused = await page.evaluate(async () => {
        const response = await document.querySelector("iframe").ask("../../etc/passwd");
        return response.status;
    });
    check("names that are no page's are refused", refused === 404);
    await page.evaluate(() => window.leave());
    check("nothing is left of it", await page.evaluate(() => !document.querySelector("iframe") && window.listening() === 0));
    check(`no errors ${errors.join("; ")}`, errors.length === 0);
} finally {
    await browser.close();
    server.close();
    kernel.stdin.end();
}
check("the kernel ends its server", (await new Promise((resolve) => kernel.once("exit", resolve))) === 0);
process.exit(bad ? 1 : 0);
