// Looks at a burn by `singe view` in the browsers that are here:
// node --experimental-websocket tests/view.mjs [--pictures FOLDER]
//
// ONLY=PATTERN runs the first case and those whose title has it. SINGE=PROGRAM, build/singe without it. It burns a coarse letter first, and then all cases look at the same cache.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdir, mkdtemp, readdir, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { serve } from "../serve.mjs";
import { BROWSERS, speedOf, until } from "./browsers.mjs";

const only = process.env.ONLY, words = process.argv.slice(2), pictures = words[0] === "--pictures" ? words[1] : null;
const ROOT = new URL("../../", import.meta.url).pathname, SINGE = process.env.SINGE ?? `${ROOT}build/singe`;
const FRAMES = 30, SIZES = [[1100, 700], [360, 740], [740, 360]];
const work = await mkdtemp(join(tmpdir(), "singe-view-test-")), cache = join(work, "letter");
let failures = 0;

/** `singe view` with these words, and the address that it prints. */
async function view(...args) {
    const process = spawn(SINGE, ["view", ...args], { stdio: ["ignore", "pipe", "inherit"] });
    const [address] = await new Promise((resolve, reject) => {
        createInterface(process.stdout).once("line", (line) => resolve([line]));
        process.once("exit", () => reject(new Error("singe view ended")));
    });
    return { address, end: () => new Promise((resolve) => { process.once("exit", resolve); process.kill("SIGINT"); }) };
}

const state = (page) => page.evaluate(() => globalThis.view.state);
const click = (page, selector) => page.evaluate((s) => document.querySelector(s).click(), selector);
const textOf = (page, selector) => page.evaluate((s) => document.querySelector(s).textContent, selector);
const ready = async (page, address, quality = 0.25) => {
    await page.open(address);
    await until(page, () => Boolean(globalThis.view), null, "the page starts");
    await page.evaluate((q) => globalThis.view.quality(q), quality);
    await until(page, () => document.querySelector("#view").classList.contains("ready"), null, "a frame is shown");
};
const goTo = async (page, frame) => {
    await page.evaluate((f) => globalThis.view.goTo(f), frame);
    await until(page, (f) => globalThis.view.state.shown === f, frame, `frame ${frame} is shown`);
};
/** The mean red, green and blue of what is drawn. */
const colour = (page) => page.evaluate(() => {
    const { stage, camera } = globalThis.view, small = document.createElement("canvas"), [w, h] = [64, 40];
    Object.assign(small, { width: w, height: h });
    stage.draw(camera);
    const pen = small.getContext("2d");
    pen.drawImage(document.querySelector("#view"), 0, 0, w, h);
    const { data } = pen.getImageData(0, 0, w, h);
    return [0, 1, 2].map((c) => { let sum = 0; for (let i = c; i < data.length; i += 4) sum += data[i]; return sum / (w * h); });
});
const SIDE = 240;
/** The greens of a square picture of a ground, and shapes on it, by even light. */
const ground = (page, kind, camera, shapes = []) => page.evaluate(([kind, camera, shapes, side]) => {
    const { stage } = globalThis.view, { room, gl, canvas } = stage, [width, height] = [canvas.width, canvas.height], kept = { ...room }, bytes = new Uint8Array(4 * side * side);
    Object.assign(room, { width: side, height: side, ground: kind, ground_height: 0, ground_colour: [0.4, 0.4, 0.4], exposure: 1, sun: [0, 0, 0], ambient: room.ambient.map((_, i) => (i < 3 ? 1 : 0)), wall_distance: null });
    const { shapes: before } = stage.frame;
    stage.frame.shapes = shapes;
    stage.resize(side, side);
    stage.draw(camera);
    stage.frame.shapes = before;
    gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    Object.assign(room, kept);
    stage.resize(width, height);
    return [...bytes.filter((_, i) => i % 4 === 1)];
}, [kind, camera, shapes, SIDE]);
const apart = (a, b) => Math.max(...a.map((v, i) => Math.abs(v - b[i])));
/** What stands outside the window, or over another card. */
const outside = (page) => page.evaluate(() => [...document.querySelectorAll("header, aside, footer, footer button, #at, #values, aside > :not([hidden])")].filter((e) => {
    const box = e.getBoundingClientRect();
    return box.width > 0 && (box.left < -1 || box.right > innerWidth + 1 || (box.bottom > innerHeight + 1 && !e.closest("aside")));
}).map((e) => e.id || e.className || e.tagName));

const CASES = {
    async "the cache opens at its first frame and is scrubbed to its last"(page, { address }) {
        await ready(page, address);
        assert.deepEqual([(await state(page)).shown, (await state(page)).last], [1, FRAMES]);
        const before = await colour(page);
        await page.evaluate((f) => { const time = document.querySelector("#time"); time.value = f; time.dispatchEvent(new Event("input")); }, FRAMES);
        await until(page, (f) => globalThis.view.state.shown === f, FRAMES, "the last frame is shown");
        const after = await colour(page);
        assert.ok(after[0] > before[0] + 3, `red ${before[0].toFixed(1)} before the fire, ${after[0].toFixed(1)} in it`);
    },
    async "keys go through time, and the plots go with it"(page) {
        await page.key("Home");
        await until(page, () => globalThis.view.state.shown === 1, null, "Home");
        await page.key("ArrowRight");
        await until(page, () => globalThis.view.state.shown === 2, null, "an arrow");
        const early = await textOf(page, "#values");
        await page.key("End");
        await until(page, (f) => globalThis.view.state.shown === f, FRAMES, "End");
        assert.notEqual(await textOf(page, "#values"), early);
        assert.equal((await state(page)).stats, FRAMES);
    },
    async "each layer has its own colours and legend"(page) {
        await goTo(page, FRAMES);
        const seen = [];
        for (const layer of ["paper", "temperature", "char", "strain", "gas", "contact", "strands"]) {
            await click(page, `[data-layer=${layer}]`);
            if (layer === "strands") await until(page, () => Boolean(globalThis.view.stage.cells), null, "the cells are there");
            const one = await colour(page), legend = await page.evaluate(() => !document.querySelector("#legend").hidden);
            assert.equal(legend, layer !== "paper");
            for (const [other, there] of seen) assert.ok(apart(one, there) > 1, `${layer} looks like ${other}`);
            seen.push([layer, one]);
        }
        await click(page, "[data-layer=gas]");
        const middle = await colour(page);
        await page.evaluate(() => { const slice = document.querySelector("#slice"); slice.value = 0.1; slice.dispatchEvent(new Event("input")); });
        assert.ok(apart(await colour(page), middle) > 0.3, "the slice moves");
        await click(page, "[data-layer=paper]");
        const lit = await colour(page);
        await click(page, "#fire");
        assert.ok(lit[0] > (await colour(page))[0] + 1, "the flames are switched off");
        await click(page, "#fire");
    },
    async "flames are those of the preview, tongue by tongue"(page) {
        const out = join(work, "preview"), [width, height] = [320, 180];
        execFileSync(SINGE, ["render", cache, "--frames", String(FRAMES), "-o", out, "--set", `preview.size=[${width}, ${height}]`, "--set", "preview.samples=8"], { stdio: "pipe" });
        const [name] = await readdir(join(out, "frames")), preview = (await readFile(join(out, "frames", name))).toString("base64");
        const [count, difference] = await page.evaluate(async ([preview, width, height]) => {
            const { stage, camera } = globalThis.view, kept = [stage.canvas.width, stage.canvas.height], [w, h] = [64, 36], small = document.createElement("canvas");
            const pen = Object.assign(small, { width: w, height: h }).getContext("2d"), picture = new Image();
            const greens = (of) => { pen.drawImage(of, 0, 0, w, h); return pen.getImageData(0, 0, w, h).data.filter((_, i) => i % 4 === 1); };
            picture.src = `data:image/png;base64,${preview}`;
            await picture.decode();
            stage.resize(width, height);
            stage.draw(camera);
            const here = greens(stage.canvas), there = greens(picture), bright = [...here.keys()].filter((i) => i < (w * h * 2) / 3 && Math.max(here[i], there[i]) > 110); // not the table
            stage.resize(...kept);
            return [bright.length, bright.reduce((sum, i) => sum + Math.abs(here[i] - there[i]), 0) / bright.length];
        }, [preview, width, height]);
        assert.ok(count > 50 && difference < 20, `of ${count} bright parts of the picture green differs by ${difference} of 255 in the mean`);
    },
    async "stone lies in slabs with dark joints, and far wood is no comb"(page) {
        const stone = await ground(page, 1, { eye: [3, 0, 1.1], target: [3, 0, 0], up: [0, 1, 0], fov: 0.9 }); // 1 m of it from above, far from what burns
        const middle = stone.slice().sort((a, b) => a - b)[stone.length >> 1], dark = stone.filter((green) => green < 0.7 * middle).length / stone.length;
        assert.ok(dark > 0.004 && dark < 0.04, `${dark} of the stone is much darker than ${middle} of 255`);
        const wood = await ground(page, 0, { eye: [3, -1.6, 0.25], target: [3, 0, 0], up: [0, 0, 1], fov: 0.25 }), mean = wood.reduce((sum, green) => sum + green) / wood.length;
        const apart = wood.slice(SIDE).reduce((sum, green, i) => sum + Math.abs(green - wood[i]), 0) / (wood.length - SIDE) / mean;
        assert.ok(apart < 0.05, `rows of the wood differ by ${apart} of its mean`);
    },
    async "a glowing ball is cooler at its limb"(page) {
        const ball = { kind: 1, position: [3, 0, 0.1], rotation: [0, 0, 0, 1], half: [0, 0, 0], radius: 0.05, height: 0, colour: [0.05, 0.05, 0.05], temperature: 1300, solid: 0 };
        const greens = await ground(page, 0, { eye: [3, -0.3, 0.1], target: [3, 0, 0.1], up: [0, 0, 1], fov: 0.4 }, [ball]), at = (x) => greens.slice(x - 4 + SIDE * 120, x + 4 + SIDE * 120).reduce((sum, green) => sum + green / 8, 0);
        assert.ok(at(120) > 1.3 * at(30) && at(30) > 20, `green is ${at(120)} in its middle, ${at(30)} at its side`);
    },
    async "dragging turns the view, and the camera comes home"(page) {
        const eye = () => page.evaluate(() => globalThis.view.camera.eye), home = await eye();
        await page.drag([500, 300], [620, 280]);
        assert.notDeepEqual(await eye(), home);
        await click(page, "#home");
        assert.deepEqual(await eye(), home);
    },
    async "a vertex tells its story over all frames"(page) {
        const at = await page.evaluate(() => { const { stage, camera } = globalThis.view; return stage.project(camera, [-0.05, 0.05, 0.001]); });
        await page.drag(at, at);
        const { picked } = await state(page);
        assert.ok(picked, "a click on the letter picks a vertex");
        await until(page, (f) => globalThis.view.state.picked?.frames === f, FRAMES, "all frames are asked for");
        assert.match(await textOf(page, "#series"), /Temperature\d+ °CMass\d+ %Strain/);
        await until(page, () => !document.querySelector("#mark").hidden, null, "the vertex is marked");
        await page.key("Escape");
        assert.equal((await state(page)).picked, null);
    },
    async "the branch's command burns"(page) {
        await goTo(page, 12);
        await click(page, "#branch");
        await page.evaluate(() => { const pace = document.querySelector("#sliders [data-key=pace]"); pace.value = 9; pace.dispatchEvent(new Event("input")); });
        const command = await page.evaluate(() => document.querySelector("#command").value), branch = join(work, "branch");
        assert.match(command, /--from \S+:12 -o \S+-12 --set pace=9$/);
        const [, ...args] = command.replace(/-o \S+/, `-o ${branch} --force`).split(" ");
        execFileSync(SINGE, [...args, "--frames", "14", "--no-preview", "--set", "sheets.0.grid.cells=[42, 59]"], { cwd: ROOT, stdio: "pipe" });
        await click(page, "#branch");
    },
    async "a picture and a video of what is seen are saved"(page) {
        const saved = (button) => page.evaluate((id) => new Promise((resolve) => {
            const make = URL.createObjectURL;
            URL.createObjectURL = (blob) => {
                URL.createObjectURL = make;
                blob.arrayBuffer().then((b) => resolve([b.byteLength, ...new Uint8Array(b, 0, 4)]));
                return make.call(URL, blob);
            };
            document.querySelector(id).click();
        }), button);
        const [bytes, ...begins] = await saved("#still");
        assert.deepEqual(begins, [0x89, 0x50, 0x4e, 0x47]);
        assert.ok(bytes > 5000, `${bytes} bytes`);
        await goTo(page, FRAMES - 3);
        if (!(await page.evaluate(() => "VideoEncoder" in globalThis))) return; // Firefox before 130
        const [length, ...webm] = await saved("#film");
        assert.deepEqual(webm, [0x1a, 0x45, 0xdf, 0xa3]);
        assert.ok(length > 2000, `${length} bytes`);
        assert.equal((await state(page)).shown, FRAMES);
    },
    async "nothing stands outside the window, from a phone to a wide screen"(page, _, name) {
        await goTo(page, 24);
        for (const [width, height] of SIZES) {
            await page.size(width, height);
            if (pictures) await page.evaluate(() => globalThis.view.quality(1));
            await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(resolve, 150)))));
            assert.deepEqual(await outside(page), [], `${width} x ${height}`);
            if (pictures) await page.picture(`${pictures}/view-${name}-${width}.png`);
            await click(page, "[data-layer=temperature]");
            await click(page, "#branch");
            assert.deepEqual(await outside(page), [], `${width} x ${height} with a branch`);
            if (pictures) await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 400)));
            if (pictures) await page.picture(`${pictures}/view-${name}-${width}-branch.png`);
            await click(page, "#branch");
            await click(page, "[data-layer=paper]");
        }
        await page.size(...SIZES[0]);
        await page.evaluate(() => globalThis.view.quality(0.25));
    },
    async "a scene burns while one looks"(page) {
        const live = await view("examples/letter", "--frames", "8", "--set", "sheets.0.grid.cells=[30, 42]");
        await ready(page, live.address);
        await until(page, () => globalThis.view.state.shown === 8 && !globalThis.view.state.burning, null, "the last frame is shown as it burns");
        assert.equal(await textOf(page, "#status"), "8 frames burnt");
        await live.end();
    },
    async "the page in web/dist burns a sheet, and holds it by hand"(page) {
        const { server, address } = await serve(), step = (seconds) => page.evaluate((s) => globalThis.page.step(s), seconds);
        await page.open(`${address}#cells=20&gas=false&match=0.0.0.0_400.20.0.0_900&pins=-95.0.0_-95.-60.0_-95.60.0`);
        await until(page, () => document.querySelector("#view")?.classList.contains("ready"), null, "the sheet is shown");
        await page.evaluate(() => globalThis.page.quality(0.2));
        const at = (point) => page.evaluate((p) => globalThis.page.project(p), point), lit = await step(1);
        assert.ok(lit.strokes.length === 1 && lit.burnt > 0.001, `burnt ${lit.burnt}`);
        await click(page, "[data-tool=hand]");
        await page.drag(await at([0.08, -0.05, 0]), await at([0.16, -0.05, 0.03]));
        assert.equal((await step(0.1)).skipped, true); // a hand was there
        const told = await page.evaluate(() => {
            const drop = new DataTransfer();
            drop.items.add(new File(["ply\nformat nonsense\n"], "broken.ply"));
            dispatchEvent(new DragEvent("drop", { dataTransfer: drop }));
            return true;
        }) && await until(page, () => document.querySelector("#hint").textContent.match(/broken.*/)?.[0], null, "a broken file is told of");
        assert.match(told, /^broken\.ply:2: /);
        server.close();
    },
};

if (pictures) await mkdir(pictures, { recursive: true });
execFileSync(SINGE, ["run", "examples/letter", "-o", cache, "--no-preview", "--frames", String(FRAMES), "--set", "sheets.0.grid.cells=[42, 59]", "--set", "pace=10"], { cwd: ROOT, stdio: "pipe" });
process.chdir(ROOT);
for (const [name, open] of Object.entries(BROWSERS)) {
    const served = await view(cache), page = await open();
    for (const [title, run] of Object.entries({ ...CASES, speed: async (page, { address }) => {
        await ready(page, address);
        await goTo(page, FRAMES);
        console.log(`${name}: ${await speedOf(page)}`);
    } })) {
        if (only && !title.match(`cache opens|${only}`)) continue;
        const begun = Date.now();
        try {
            await run(page, served, name.toLowerCase());
            console.log(`${name}: ${title} (${((Date.now() - begun) / 1000).toFixed(1)} s)`);
        } catch (error) {
            failures++;
            console.log(`FAILED ${name}: ${title}\n  ${String(error.message).split("\n").slice(0, 6).join("\n  ")}`);
        }
    }
    for (const message of page.errors) { failures++; console.log(`FAILED ${name}: error on the page: ${message}`); }
    await page.close();
    await served.end();
}
await rm(work, { recursive: true, force: true });
for (const name of ["Chromium", "Firefox"]) if (!BROWSERS[name]) console.log(`${name} is not here, and was left out`);
console.log(`${Object.keys(BROWSERS).join(", ") || "no browser is here"}: ${failures ? `${failures} failures` : "all is well"}`);
process.exitCode = failures || !Object.keys(BROWSERS).length ? 1 : 0;
