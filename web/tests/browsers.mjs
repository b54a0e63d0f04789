// Chromium and Firefox behind the same few words. Both are the system's own, and draw without a card.
//
// Chromium is driven by playwright-core. It cannot drive an unchanged Firefox, so that one is spoken to directly in
// WebDriver BiDi, in a window of Xvfb: without a window Firefox has no WebGL here. Needs node --experimental-websocket.
import { spawn } from "node:child_process";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
const FIREFOX = process.env.FIREFOX ?? "/usr/bin/firefox-esr";
// flags for a machine with a card are in docs/web.md; without one, plain canvases are quicker by the processor itself
export const CHROMIUM_ARGS = ["--no-sandbox", ...(process.env.CHROMIUM_FLAGS ?? "--use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --disable-accelerated-2d-canvas").split(" ")];
const PATIENCE = 60_000;
const KEYS = { Escape: "\uE00C", Home: "\uE011", End: "\uE010", ArrowLeft: "\uE012", ArrowRight: "\uE014" };

async function chromiumPage() {
    const browser = await chromium.launch({ executablePath: CHROMIUM, args: CHROMIUM_ARGS });
    const page = await browser.newPage({ viewport: { width: 1100, height: 700 } }), errors = [], { mouse } = page;
    page.setDefaultTimeout(2 * PATIENCE); // a busy machine starts slowly
    page.on("pageerror", (error) => errors.push(error.message));
    return {
        errors, mouse,
        open: (address) => page.goto(address),
        evaluate: (call, argument) => page.evaluate(call, argument),
        size: (width, height) => page.setViewportSize({ width, height }),
        async drag(from, to) {
            await page.mouse.move(...from);
            await page.mouse.down();
            await page.mouse.move(...to, { steps: 3 });
            await page.mouse.up();
        },
        key: (name) => page.keyboard.press(name),
        picture: async (path) => { await page.screenshot({ path }); },
        close: () => browser.close(),
    };
}

/** Sends commands and hands answers to those who asked. */
class Session {
    constructor(socket) {
        this.socket = socket;
        this.asked = new Map();
        this.number = 0;
        socket.addEventListener("message", ({ data }) => {
            const answer = JSON.parse(data), { resolve, reject } = this.asked.get(answer.id) ?? {};
            this.asked.delete(answer.id);
            if (answer.type === "success") resolve?.(answer.result);
            else if (answer.type === "error") reject?.(new Error(answer.message));
        });
    }
    send(method, params) {
        const id = ++this.number;
        this.socket.send(JSON.stringify({ id, method, params }));
        return new Promise((resolve, reject) => this.asked.set(id, { resolve, reject }));
    }
}

async function firefoxPage() {
    const profile = await mkdtemp(join(tmpdir(), "singe-firefox-"));
    await writeFile(join(profile, "user.js"), 'user_pref("webgl.force-enabled", true);\nuser_pref("app.update.enabled", false);\n');
    const program = [FIREFOX, "--remote-debugging-port", "0", "--profile", profile, "--no-remote", "about:blank"];
    const process = spawn("xvfb-run", ["-a", "-s", "-screen 0 1600x1200x24", ...program], { stdio: ["ignore", "ignore", "pipe"], detached: true });
    const url = await new Promise((resolve, reject) => {
        let said = "";
        process.stderr.on("data", (text) => {
            said += text;
            const [, address] = /WebDriver BiDi listening on (ws:\S+)/.exec(said) ?? [];
            if (address) resolve(`${address}/session`);
        });
        process.on("exit", () => reject(new Error(`Firefox ended: ${said.slice(-400)}`)));
        setTimeout(() => reject(new Error("Firefox does not listen")), PATIENCE).unref();
    });
    const socket = new WebSocket(url);
    await new Promise((resolve, reject) => { socket.onopen = resolve; socket.onerror = reject; });
    const session = new Session(socket);
    await session.send("session.new", { capabilities: {} });
    const context = (await session.send("browsingContext.getTree", {})).contexts[0].context;
    const act = (actions) => session.send("input.performActions", { context, actions });
    const page = {
        errors: [],
        open: (url) => session.send("browsingContext.navigate", { context, url, wait: "complete" }),
        async evaluate(call, argument) {
            const expression = `(async () => JSON.stringify(await (${call})(${JSON.stringify(argument) ?? ""})) ?? "null")()`;
            const answer = await session.send("script.evaluate", { expression, target: { context }, awaitPromise: true });
            if (answer.type === "exception") throw new Error(answer.exceptionDetails.text);
            return JSON.parse(answer.result.value);
        },
        size: (width, height) => session.send("browsingContext.setViewport", { context, viewport: { width, height } }),
        drag: ([x, y], [u, v]) => act([{ type: "pointer", id: "mouse", actions: [
            { type: "pointerMove", x: Math.round(x), y: Math.round(y) }, { type: "pointerDown", button: 0 },
            { type: "pointerMove", x: Math.round(u), y: Math.round(v), duration: 60 }, { type: "pointerUp", button: 0 },
        ] }]),
        key: (name) => act([{ type: "key", id: "keys", actions: ["keyDown", "keyUp"].map((type) => ({ type, value: KEYS[name] ?? name })) }]),
        async picture(path) {
            const { data } = await session.send("browsingContext.captureScreenshot", { context });
            await writeFile(path, Buffer.from(data, "base64"));
        },
        async close() {
            const ended = new Promise((resolve) => process.once("exit", resolve));
            await session.send("browser.close", {}).catch(() => {});
            await ended;
            await rm(profile, { recursive: true, force: true, maxRetries: 5 });
        },
    };
    await page.size(1100, 700);
    return page;
}

/**
 * Seconds of processor time, by /proc, of what this process has started: pages' own threads, their workers', of the process
 * that draws, whose memory is told as well, and in all. A busy machine changes it less than the clock.
 */
export function processorTime() {
    const TICK = 100, time = { page: 0, worker: 0, card: 0, cardBytes: 0, all: 0 };
    const read = (path) => {
        const text = readFileSync(path, "utf8"), fields = text.slice(text.lastIndexOf(")") + 2).split(" ");
        return { name: text.slice(text.indexOf("(") + 1, text.lastIndexOf(")")), parent: Number(fields[1]), spent: (Number(fields[11]) + Number(fields[12])) / TICK };
    };
    const processes = new Map();
    for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name)))
        try { processes.set(Number(id), read(`/proc/${id}/stat`)); } catch { /* it has ended */ }
    const ours = (id) => id === process.pid || (processes.has(id) && ours(processes.get(id).parent));
    for (const [id, { parent, spent }] of processes) {
        if (!ours(parent)) continue;
        time.all += spent;
        try {
            const [, kind] = /--type=([\w-]+)/.exec(readFileSync(`/proc/${id}/cmdline`, "utf8")) ?? [];
            if (kind === "gpu-process") {
                time.card += spent;
                time.cardBytes += 1024 * Number(/VmRSS:\s*(\d+)/.exec(readFileSync(`/proc/${id}/status`, "utf8"))[1]);
            }
            if (kind !== "renderer") continue;
            for (const thread of readdirSync(`/proc/${id}/task`)) {
                const { name } = read(`/proc/${id}/task/${thread}/stat`), spent = parseInt(readFileSync(`/proc/${id}/task/${thread}/schedstat`, "utf8")) / 1e9;
                if (Number(thread) === id) time.page += spent;
                else if (/^DedicatedWorker/.test(name)) time.worker += spent;
            }
        } catch { /* it has ended */ }
    }
    return time;
}

/** The browsers that are here, by name. */
export const BROWSERS = Object.fromEntries(
    [["Chromium", CHROMIUM, chromiumPage], ["Firefox", FIREFOX, firefoxPage]].filter(([, path]) => existsSync(path)).map(([name, , open]) => [name, open]),
);

/** Waits until what the page computes is true, and returns it. */
export async function until(page, call, argument, what = String(call)) {
    for (const end = Date.now() + PATIENCE; Date.now() < end; await new Promise((resolve) => setTimeout(resolve, 60))) {
        const value = await page.evaluate(call, argument);
        if (value) return value;
    }
    throw new Error(`it did not happen: ${what}`);
}

/** Frames a second of what `singe view` shows, in whole pixels. */
export const speedOf = (page) => page.evaluate(() => {
    globalThis.view.quality(1);
    const { stage, camera } = globalThis.view, { gl, canvas, frame } = stage, info = gl.getExtension("WEBGL_debug_renderer_info");
    const wait = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    const timed = (times) => {
        const before = performance.now();
        for (let i = 0; i < times; i++) stage.draw(camera);
        wait();
        return (performance.now() - before) / times;
    };
    timed(1); // shaders are compiled
    const once = timed(2), rate = 1000 / (once > 100 ? once : timed(Math.min(Math.ceil(500 / once), 200)));
    return `${frame.triangleCount} triangles, ${canvas.width} x ${canvas.height} pixels at ${rate.toFixed(2)} frames/s by ${gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER)}`;
});

/** Whether this is the name of a graphics card, not of a program in its place. */
export const isCard = (name) => !/SwiftShader|llvmpipe/i.test(name);

/**
 * Turns the view of the page, or of `singe view`, for some seconds with a button of Chromium's mouse. Frames a second by the
 * clock, and ms between two of them, which half and a twentieth exceed. As each drawing ends with a fence, fences are counted,
 * and as the next one waits for the card, all of them were drawn.
 */
export async function turned(page, button, seconds) {
    await page.mouse.move(300, 200);
    await page.mouse.down({ button });
    const times = await page.evaluate(([s, held]) => new Promise((resolve) => {
        const { prototype } = WebGL2RenderingContext, { fenceSync } = prototype, canvas = document.querySelector("#view"), times = [], begun = performance.now();
        prototype.fenceSync = function (...words) {
            times.push(performance.now());
            return fenceSync.apply(this, words);
        };
        const move = (now) => {
            const turn = (now - begun) / 1000, at = { clientX: 300 + 100 * Math.sin(turn), clientY: 200 + 20 * Math.sin(2 * turn) };
            canvas.dispatchEvent(new PointerEvent("pointermove", { ...at, pointerId: 1, pointerType: "mouse", buttons: held, bubbles: true }));
            if (turn < s) return requestAnimationFrame(move);
            prototype.fenceSync = fenceSync;
            resolve(times);
        };
        requestAnimationFrame(move);
    }), [seconds, button === "left" ? 1 : 2]);
    await page.mouse.up({ button });
    const gaps = times.slice(1).map((time, i) => time - times[i]).sort((a, b) => a - b), [half, late] = [0.5, 0.95].map((share) => gaps[Math.floor(share * gaps.length)] ?? Infinity);
    return { rate: times.length / seconds, half, late };
}
