// What `singe view` costs with a large cache, in Chromium: node tests/large.mjs CACHE [FOLDER]
//
// Prints the cache's size, what the server reads (by /proc) until the first frame is shown and for a frame far behind it,
// how long both take, and how fast the last frame is drawn; then what the page's own thread needs to turn the view and to
// show a new frame, and what is reached while the view is turned, and while it plays. Fails if opening reads more than a
// quarter of the cache, or if that thread alone, or a card, could not turn the view 30 times a second. FOLDER gets a
// picture, large.png.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { readdir, stat } from "node:fs/promises";
import { createInterface } from "node:readline";
import { BROWSERS, CHROMIUM_ARGS, isCard, speedOf, turned, until } from "./browsers.mjs";

const [cache, folder] = process.argv.slice(2), TURNED = 5, RATE = 30, SINGE = process.env.SINGE ?? new URL("../../build/singe", import.meta.url).pathname;
const MB = (bytes) => `${(bytes / 1e6).toFixed(1)} MB`;

const files = await readdir(cache, { recursive: true }), sizes = await Promise.all(files.map(async (name) => (await stat(`${cache}/${name}`)).size));
const whole = sizes.reduce((a, b) => a + b, 0), server = spawn(SINGE, ["view", cache], { stdio: ["ignore", "pipe", "inherit"] });
const address = await new Promise((resolve) => createInterface(server.stdout).once("line", resolve));
const bytesRead = () => Number(readFileSync(`/proc/${server.pid}/io`, "utf8").match(/rchar: (\d+)/)[1]);

const page = await BROWSERS.Chromium();
if (isCard(CHROMIUM_ARGS.join(" "))) await page.size(1920, 1080);
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
    const drawn = await speedOf(page), card = isCard(drawn);
    console.log(drawn);
    await page.evaluate(() => globalThis.view.quality(0.05));
    const [thread, shown, bytes] = await page.evaluate(() => {
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
    console.log(`the page's thread: ${thread.toFixed(1)} ms to turn the view, ${shown.toFixed(1)} ms to show a frame of ${MB(bytes)}`);
    await page.evaluate(() => globalThis.view.quality(null));
    const { rate, half, late } = await turned(page, "left", TURNED), width = await page.evaluate(() => document.querySelector("#view").width);
    console.log(`turned for ${TURNED} s: ${rate.toFixed(1)} frames/s, half of them within ${half.toFixed(1)} ms, 95 % within ${late.toFixed(1)} ms, ${width} pixels wide`);
    if (folder) await page.picture(`${folder}/large.png`);
    await page.key("Home");
    await until(page, () => globalThis.view.state.shown === globalThis.view.state.first, null, "the first frame is shown");
    begun = performance.now();
    await page.evaluate(() => globalThis.view.play(true));
    await until(page, () => globalThis.view.state.shown === globalThis.view.state.last, null, "it plays to its end");
    console.log(`played: ${(last / ((performance.now() - begun) / 1000)).toFixed(1)} frames/s`);
    assert.ok(thread < 1000 / RATE && (!card || rate > RATE), `${thread} ms, or ${rate} times a second, to turn the view`);
    assert.ok(opened + scrubbed < whole / 4, `${MB(opened + scrubbed)} of ${MB(whole)} were read for two frames`);
} finally {
    await page.close();
    server.kill("SIGINT");
}
