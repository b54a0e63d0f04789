// What `singe view` costs with a large cache, in Chromium: node tests/large.mjs CACHE
//
// Prints the cache's size, what the server reads (by /proc) until the first frame is shown and for a frame far behind it,
// how long both take, and how fast the last frame is drawn; then what the page's own thread needs to turn the view and to
// show a new frame. Fails if opening reads more than a quarter of the cache, or if that thread alone could not turn the view
// 30 times a second.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { readdir, stat } from "node:fs/promises";
import { createInterface } from "node:readline";
import { BROWSERS, speedOf, until } from "./browsers.mjs";

const cache = process.argv[2], SINGE = process.env.SINGE ?? new URL("../../build/singe", import.meta.url).pathname;
const MB = (bytes) => `${(bytes / 1e6).toFixed(1)} MB`;

const files = await readdir(cache, { recursive: true }), sizes = await Promise.all(files.map(async (name) => (await stat(`${cache}/${name}`)).size));
const whole = sizes.reduce((a, b) => a + b, 0), server = spawn(SINGE, ["view", cache], { stdio: ["ignore", "pipe", "inherit"] });
const address = await new Promise((resolve) => createInterface(server.stdout).once("line", resolve));
const bytesRead = () => Number(readFileSync(`/proc/${server.pid}/io`, "utf8").match(/rchar: (\d+)/)[1]);

const page = await BROWSERS.Chromium();
try {
    let begun = performance.now(), before = 0;
    const told = (what) => {
        const read = bytesRead() - before;
        console.log(`${what}: ${MB(read)} read in ${((performance.now() - begun) / 1000).toFixed(2)} s`);
        begun = performance.now();
        before += read;
        return read;
    };
    console.log(`cache: ${MB(whole)} in ${files.length} files`);
    await page.open(address);
    await until(page, () => Boolean(globalThis.view), null, "the page starts");
    await page.evaluate(() => globalThis.view.quality(0.1));
    await until(page, () => document.querySelector("#view").classList.contains("ready"), null, "a frame is shown");
    const opened = told("the first frame is shown"), last = await page.evaluate(() => globalThis.view.state.last);
    await page.evaluate((f) => globalThis.view.goTo(f), last);
    await until(page, (f) => globalThis.view.state.shown === f, last, "the last frame is shown");
    const scrubbed = told(`frame ${last} is shown`);
    console.log(await speedOf(page));
    await page.evaluate(() => globalThis.view.quality(0.05));
    const [turned, shown, bytes] = await page.evaluate(() => {
        const { stage, camera } = globalThis.view, { gl, frame } = stage;
        /** ms of this thread, the least of some tries, each of which begins when the card has nothing to do. */
        const least = (call) => Math.min(...Array.from({ length: 4 }, () => {
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
            const begun = performance.now();
            call();
            return performance.now() - begun;
        }));
        return [least(() => stage.draw(camera)), least(() => { stage.show(frame); stage.draw(camera); }), frame.buffer.byteLength];
    });
    console.log(`the page's thread: ${turned.toFixed(1)} ms to turn the view, ${shown.toFixed(1)} ms to show a frame of ${MB(bytes)}`);
    assert.ok(turned < 1000 / 30, `${turned} ms to turn the view`);
    assert.ok(opened + scrubbed < whole / 4, `${MB(opened + scrubbed)} of ${MB(whole)} were read for two frames`);
} finally {
    await page.close();
    server.kill("SIGINT");
}
