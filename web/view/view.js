// The view: asks the program for state, frames and tables, and shows them. All addresses are relative, behind the token.
import { cssGradient, LAYERS, legendOf } from "./layers.js";
import { Stage } from "./stage.js";
import { pick, positionOf, readFrame, sourceOf, vertexValues } from "./frame.js";
import { Film } from "./webm.js";
import { Pixels } from "./pixels.js";
import { add, cross, dot, length, unit } from "./math.js";
import { readCells } from "./strands.js";
import { drawLines, EVENT_COLOURS, PLOTS, readTable } from "./plots.js";

const $ = (id) => document.getElementById(id);
const canvas = $("view"), KEEP_BYTES = 256 << 20;
let stage, pixels, state = null, room = null, run = 0, record = null;
let stats = [], events = [], camera = null, wanted = 1, shown = 0, playing = false, following = true, plot = "Fire";
let picked = null; // {source, series: Map}
let dirty = true, played = 0;

function stop(message) {
    $("stop").textContent = message;
    $("stop").hidden = false;
}

async function ask(path, kind = "json") {
    const response = await fetch(path);
    if (!response.ok) throw Object.assign(new Error(await response.text()), { status: response.status });
    return response[kind]();
}
const ofRun = (path, kind) => ask(`run/${run}/${path}`, kind);

// ---- frames: the last ones are kept

const kept = new Map(), coming = new Map();
function frameOf(number) {
    const had = kept.get(number);
    if (had) {
        kept.delete(number);
        kept.set(number, had); // the newest last
        return Promise.resolve(had);
    }
    if (!coming.has(number)) {
        const mine = run;
        coming.set(number, ofRun(`frame/${number}`, "arrayBuffer").then((buffer) => {
            const frame = readFrame(buffer);
            if (mine !== run) throw new Error("of an earlier run");
            kept.set(number, frame);
            let bytes = 0;
            for (const { buffer: one } of kept.values()) bytes += one.byteLength;
            for (const [old, { buffer: one }] of kept) {
                if (bytes <= KEEP_BYTES || old === number) break;
                kept.delete(old);
                bytes -= one.byteLength;
            }
            return frame;
        }).finally(() => coming.delete(number)));
    }
    return coming.get(number);
}

let busy = false;
async function advanceTo(number) {
    wanted = Math.min(Math.max(number, state.first), state.last);
    if (busy) return;
    busy = true;
    try {
        while (shown !== wanted) {
            const next = wanted, frame = await frameOf(next);
            stage.show(frame);
            await Promise.all(frame.shapes.map(async (shape, i) => {
                if (shape.solid && !stage.solids.has(stage.solidKey(i))) stage.addSolid(i, await ofRun(`solid/${next}/${i}`, "arrayBuffer"));
            }));
            shown = next;
            dirty = true;
            canvas.classList.add("ready");
            showFacts();
        }
    } catch (error) {
        if (error.status !== 404) console.warn(error.message);
        if (shown !== wanted) wanted = shown || wanted;
    }
    busy = false;
}

// ---- a run

async function beginRun(number) {
    run = number;
    kept.clear();
    coming.clear();
    shown = 0;
    room = await ofRun("room");
    record = await ofRun("run.json").catch(() => null);
    const pictures = await Promise.all(["picture", "back"].flatMap((side) => room.sheets.map((sheet) => sheet[side])).map(async (there, i) => {
        if (!there) return null;
        const buffer = await ofRun(`picture/${i}`, "arrayBuffer"), [width, height] = new Uint32Array(buffer, 0, 2);
        const rgb = new Uint8Array(buffer, 8), rgba = new Uint8Array(4 * width * height);
        for (let y = 0; y < height; y++)
            for (let x = 0; x < width; x++) {
                const from = 3 * ((height - 1 - y) * width + x), to = 4 * (y * width + x); // texture coordinates count from below
                rgba[to] = rgb[from];
                rgba[to + 1] = rgb[from + 1];
                rgba[to + 2] = rgb[from + 2];
                rgba[to + 3] = 255;
            }
        return { width, height, rgba };
    }));
    stage.setRoom(room, pictures);
    if (stage.layer === "strands") needCells();
    if (!camera) goHome();
    $("name").textContent = room.name;
    document.title = `${room.name} · singe view`;
    stats = events = [];
    await readTables();
    makeSliders();
    if (picked) pickSeries(picked.source);
}

async function readTables() {
    stats = readTable(await ofRun("stats.csv", "text").catch(() => ""));
    events = readTable(await ofRun("events.csv", "text").catch(() => ""));
    showFacts();
}

async function look() {
    let wait = 1000;
    try {
        const before = state;
        state = await ask("state");
        if (state.live) wait = state.burning || state.newest !== state.run ? 120 : 250;
        if (state.run && state.run !== run) await beginRun(state.run);
        const more = !before || before.last !== state.last || before.run !== state.run;
        if (state.run && state.last) {
            const slider = $("time");
            slider.min = state.first;
            slider.max = state.live ? Math.max(room.frames, state.last) : state.last;
            if (more) {
                await readTables();
                if (state.live && following && !playing) await advanceTo(state.last);
            }
            if (!shown) await advanceTo(state.live && following ? state.last : state.first);
        }
        showState();
    } catch (error) {
        $("status").textContent = "singe view has ended";
        $("status").className = "";
        wait = 2000;
    }
    setTimeout(look, wait);
}

function showState() {
    const { live, burning, log } = state, newer = live && state.newest !== state.run, failed = live && !burning && state.exit > 0;
    $("live").hidden = !live;
    $("status").className = live && burning ? "burning" : "";
    $("status").textContent = !live ? `${state.last - state.first + 1} frames, ${room ? (1 / room.fps * (state.last - state.first)).toFixed(1) : ""} s`
        : failed ? (run ? "as it was before the last change" : "nothing to see yet")
        : newer ? (run ? "burning again…" : "burning the first frame…") : burning ? `burning frame ${state.last + 1} of ${room.frames}` : `${state.last} frames burnt`;
    $("trouble").hidden = !failed;
    if (failed) $("trouble").lastElementChild.textContent = log.trim();
}

// ---- the camera: it turns about `target`, with the scene's upright

function goHome() {
    camera = { eye: [...room.eye], target: [...room.target], up: unit(room.up), fov: room.fov };
    dirty = true;
}

function frameAxes() {
    const back = add(camera.eye, camera.target, -1), far = length(back), z = unit(back), x = unit(cross(camera.up, z));
    return { far, z, x, y: cross(z, x) };
}

function turn(right, up) {
    const { far, z, x } = frameAxes(), side = cross(x, camera.up); // level, towards the eye
    const height = Math.asin(Math.min(Math.max(dot(z, camera.up), -1), 1)), tall = Math.min(Math.max(height + up, -1.5), 1.5);
    const level = unit(add(side.map((s) => s * Math.cos(right)), x, -Math.sin(right)));
    camera.eye = add(camera.target, add(level.map((s) => s * Math.cos(tall)), camera.up, Math.sin(tall)), far);
    dirty = true;
}

function move(dx, dy) {
    const { far, x, y } = frameAxes(), scale = (2 * far * Math.tan(camera.fov / 2)) / canvas.clientHeight;
    const by = add(x.map((s) => -s * dx * scale), y, dy * scale);
    camera.eye = add(camera.eye, by);
    camera.target = add(camera.target, by);
    dirty = true;
}

function nearer(factor) {
    const { far, z } = frameAxes();
    camera.eye = add(camera.target, z, Math.min(Math.max(far * factor, 0.004), 60));
    dirty = true;
}

const fingers = new Map();
let dragged = 0;
canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    dragged = fingers.size > 1 ? 99 : 0;
});
canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before || !camera) return;
    const now = [event.clientX, event.clientY], dx = now[0] - before[0], dy = now[1] - before[1];
    dragged += Math.abs(dx) + Math.abs(dy);
    if (fingers.size === 2) {
        const other = [...fingers].find(([id]) => id !== event.pointerId)[1], far = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        nearer(far(before) / far(now));
        move(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) move(dx, dy);
    else turn(dx * 0.0065, dy * 0.0065);
    fingers.set(event.pointerId, now);
});
for (const name of ["pointerup", "pointercancel"])
    canvas.addEventListener(name, (event) => {
        if (name === "pointerup" && fingers.size === 1 && dragged < 4 && event.button === 0) pickAt(event.clientX, event.clientY);
        fingers.delete(event.pointerId);
    });
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    nearer(Math.exp(Math.min(Math.max(event.deltaY, -200), 200) * 0.0013));
}, { passive: false });

// ---- a vertex over time

function pickAt(x, y) {
    if (!stage.frame) return;
    const { origin, direction } = stage.ray(camera, x, y), hit = pick(stage.frame, origin, direction);
    openBranch(false);
    if (hit) pickSeries(hit.source);
    else forget();
}

function forget() {
    picked = null;
    $("vertex").hidden = true;
    dirty = true;
}

const SERIES = [["Temperature", 0, "#e2533f", (k) => `${Math.round(k - 273.15)} °C`], ["Mass", 1, "#d9c7a4", (m) => `${(100 * m).toFixed(0)} %`], ["Strain", 5, "#9cc28a", (s) => `${s > 0 ? "+" : ""}${(100 * s).toFixed(1)} %`]];

async function pickSeries(source) {
    const mine = (picked = { source, series: new Map() }), box = $("series");
    $("vertex").hidden = false;
    $("vertex").querySelector("b").textContent = source;
    box.replaceChildren(...SERIES.map(([title]) => {
        const one = document.createElement("div");
        one.className = "one";
        one.append(Object.assign(document.createElement("span"), { textContent: title }), document.createElement("b"), document.createElement("canvas"));
        return one;
    }));
    showVertex();
    // coarse at first, at most 240 of many frames
    const every = Math.max(1, Math.ceil((state.last - state.first + 1) / 240)), order = [];
    for (let step = 16; step >= 1; step >>= 1)
        for (let f = state.first; f <= state.last; f += every * step) if (!order.includes(f)) order.push(f);
    for (const number of order) {
        if (picked !== mine) return;
        const answer = await ofRun(`vertex/${number}/${source}`).catch(() => null);
        if (answer) mine.series.set(number, answer.values);
        showVertex();
    }
}

function showVertex() {
    if (!picked) return;
    const points = [...picked.series].sort((a, b) => a[0] - b[0]), { frame } = stage;
    let here = null;
    for (let i = 0; i < frame.vertexCount && here === null; i++) if (sourceOf(frame, i) === picked.source) here = i;
    const values = here === null ? null : vertexValues(frame, here), now = values ? { 0: values.temperature, 1: values.mass, 5: values.stretch } : null;
    [...$("series").children].forEach((one, k) => {
        const [, index, colour, show] = SERIES[k];
        one.children[1].textContent = now ? show(now[index]) : "gone";
        drawLines(one.children[2], [{ axis: 0, colour, tight: true, points: points.map(([f, v]) => [f, v[index]]) }], { first: +$("time").min, last: +$("time").max, now: shown });
    });
    const at = here === null ? null : positionOf(frame, here);
    if (`${at}` !== `${picked.at}`) dirty = true; // its mark moves; the plots alone need no new picture
    picked.at = at;
}

// ---- plots, numbers, timeline

function showFacts() {
    if (!state || !room) return;
    const first = +$("time").min, last = +$("time").max, lines = PLOTS[plot].filter(([key]) => stats.length && key in stats[0]);
    const row = stats.find(({ frame }) => frame === shown);
    drawLines($("plot"), lines.map(([key, , colour, , axis]) => ({ axis: axis ?? key, colour, points: stats.map((r) => [r.frame, r[key]]) })), {
        first, last, now: shown, inset: 8, done: state.last,
        ticks: events.map((e) => ({ frame: 1 + e.time * room.fps, colour: EVENT_COLOURS[e.event] ?? EVENT_COLOURS[e.kind] ?? "#d9c7a4" })),
    });
    $("values").replaceChildren(...lines.map(([key, title, colour, show]) => {
        const one = document.createElement("span"), line = document.createElement("i"), value = document.createElement("b");
        line.style.background = colour;
        value.textContent = row ? show(row[key]) : "–";
        one.append(line, `${title} `, value);
        return one;
    }));
    $("time").value = shown;
    $("at").replaceChildren(`${shown}`, ...[` / ${last}`, `   ${((shown - 1) / room.fps).toFixed(2)} s`].map((textContent) => Object.assign(document.createElement("span"), { textContent })));
    $("from").textContent = shown;
    writeCommand();
    showVertex();
}

function play(on) {
    playing = on;
    $("play").setAttribute("aria-pressed", on);
    $("play").setAttribute("aria-label", on ? "Pause" : "Play");
    played = performance.now();
    if (on && shown >= state.last) advanceTo(state.first);
    if (on) follow(false);
}
function follow(on) {
    following = on;
    $("live").setAttribute("aria-pressed", on);
    if (on && state?.last) { play(false); advanceTo(state.last); }
}
function goTo(number) {
    play(false);
    follow(false);
    advanceTo(number);
}

function setLayer(name) {
    stage.layer = name;
    for (const button of $("layers").children) button.setAttribute("aria-checked", button.dataset.layer === name);
    const layer = LAYERS[name];
    $("legend").hidden = !layer;
    $("slice").hidden = name !== "gas";
    if (layer) {
        $("legend").firstElementChild.style.background = cssGradient(name);
        $("legend").classList.toggle("names", Boolean(layer.names));
        $("legend").querySelector("p").replaceChildren(...legendOf(name).map((textContent) => Object.assign(document.createElement("span"), { textContent })));
    }
    if (name === "strands") needCells();
    dirty = true;
}

/** The cells of the run's sheets, which one layer alone needs. */
async function needCells() {
    if (!room || stage.cells) return;
    const mine = run, buffer = await ofRun("cells", "arrayBuffer").catch(() => null);
    if (!buffer || mine !== run || stage.cells) return;
    stage.setCells(readCells(buffer));
    dirty = true;
}

// ---- branching: the command that continues from here

const BRANCHES = [
    ["pace", "Pace of the fire", 0.25, 20, 0.25, (s) => s.pace], ["wind.velocity.0", "Wind along x, m/s", -4, 4, 0.1, (s) => s.wind?.velocity?.[0]],
    ["wind.velocity.1", "Wind along y, m/s", -4, 4, 0.1, (s) => s.wind?.velocity?.[1]], ["gravity.2", "Gravity, m/s²", -20, 5, 0.1, (s) => s.gravity?.[2]],
];
const quote = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function makeSliders() {
    $("sliders").replaceChildren(...BRANCHES.flatMap(([key, title, low, high, step, read]) => {
        const value = record ? read(record.scene) : undefined;
        if (typeof value !== "number") return [];
        const label = document.createElement("label"), output = document.createElement("output"), input = document.createElement("input");
        Object.assign(input, { type: "range", min: Math.min(low, value), max: Math.max(high, value), step: "any", value });
        input.dataset.key = key;
        input.dataset.was = value;
        input.addEventListener("input", () => {
            input.value = Math.abs(input.value - value) < (high - low) / 80 ? value : Math.round(input.value / step) * step; // the old value is easily found again
            writeCommand();
        });
        label.append(title, output, input);
        return [label];
    }));
    writeCommand();
}

function writeCommand() {
    const inputs = [...$("sliders").querySelectorAll("input")], changes = new Map();
    for (const input of inputs) {
        const value = +(+input.value).toFixed(4), changed = value !== +input.dataset.was;
        input.previousElementSibling.textContent = value;
        input.parentElement.classList.toggle("changed", changed);
        if (!changed) continue;
        const [, list, index] = /^(.*)\.(\d)$/.exec(input.dataset.key) ?? [];
        if (!list) { changes.set(input.dataset.key, value); continue; }
        const whole = changes.get(list) ?? [...list.split(".").reduce((o, k) => o[k], record.scene)];
        whole[+index] = value;
        changes.set(list, whole);
    }
    const from = state.live ? "DIR" : state.folder, scene = state.live ? state.scene : (record?.scene_file ?? "SCENE");
    const sets = [...changes].map(([key, value]) => `--set ${quote(`${key}=${Array.isArray(value) ? `[${value.join(", ")}]` : value}`)}`);
    $("command").value = ["singe run", quote(scene), "--from", quote(`${from}:${shown}`), "-o", quote(`${from}-${shown}`), ...sets].join(" ");
}

// ---- buttons and keys

async function saveStill() {
    draw(true);
    const blob = await new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
    save(blob, `${room.name}.${String(shown).padStart(4, "0")}${stage.layer === "paper" ? "" : `.${stage.layer}`}.png`);
}

/** A video from this frame to the last, or until the button is pressed again. It waits for frames that come slowly. */
let filming = false;
async function saveFilm() {
    if (filming) { filming = false; return; }
    filming = true;
    play(false);
    follow(false);
    $("film").textContent = "Stop";
    try {
        draw(true);
        const film = await Film.make(canvas, room.fps);
        if (!film) throw new Error("this browser has no WebCodecs, which videos need");
        if (shown >= state.last) await advanceTo(state.first);
        for (let frame = shown; filming && frame <= state.last; frame++) {
            await advanceTo(frame);
            draw(true);
            film.add();
            while (film.encoder.encodeQueueSize > 4) await new Promise((resolve) => setTimeout(resolve, 5));
        }
        save(await film.end(), `${room.name}.webm`);
    } catch (error) {
        $("status").textContent = `No video: ${error.message}`;
    }
    filming = false;
    $("film").textContent = "Video";
}
function save(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
function setFire(on) {
    stage.fire = on;
    $("fire").setAttribute("aria-pressed", on);
    dirty = true;
}
function openBranch(on) {
    $("branching").hidden = !on;
    if (on) forget();
    $("branch").setAttribute("aria-expanded", on);
    if (on) play(false);
}

function bind() {
    $("layers").addEventListener("click", ({ target }) => target.dataset.layer && setLayer(target.dataset.layer));
    $("home").addEventListener("click", goHome);
    $("fire").addEventListener("click", () => setFire(!stage.fire));
    $("still").addEventListener("click", saveStill);
    $("film").addEventListener("click", saveFilm);
    $("slice").addEventListener("input", () => {
        stage.slice = +$("slice").value;
        dirty = true;
    });
    $("branch").addEventListener("click", () => openBranch($("branching").hidden));
    $("copy").addEventListener("click", async () => {
        $("command").select();
        await navigator.clipboard?.writeText($("command").value).catch(() => document.execCommand("copy"));
        $("copy").textContent = "Copied";
        setTimeout(() => { $("copy").textContent = "Copy"; }, 1500);
    });
    $("vertex").querySelector("button").addEventListener("click", forget);
    $("play").addEventListener("click", () => play(!playing));
    $("live").addEventListener("click", () => follow(!following));
    $("time").addEventListener("input", () => goTo(+$("time").value));
    $("tabs").replaceChildren(...Object.keys(PLOTS).map((name) => {
        const tab = Object.assign(document.createElement("button"), { type: "button", textContent: name });
        tab.setAttribute("role", "tab");
        tab.setAttribute("aria-selected", name === plot);
        tab.addEventListener("click", () => {
            plot = name;
            for (const one of $("tabs").children) one.setAttribute("aria-selected", one === tab);
            showFacts();
        });
        return tab;
    }));
    const scrub = (event) => {
        const box = $("plot").getBoundingClientRect(), first = +$("time").min, last = +$("time").max;
        goTo(Math.round(first + ((last - first) * (event.clientX - box.left - 8)) / (box.width - 16)));
    };
    $("plot").addEventListener("pointerdown", (event) => { $("plot").setPointerCapture(event.pointerId); scrub(event); });
    $("plot").addEventListener("pointermove", (event) => event.buttons && scrub(event));
    addEventListener("keydown", (event) => {
        if (!room || event.ctrlKey || event.metaKey || event.altKey || event.target.matches("textarea, input:not(#time)")) return;
        const button = event.target.matches("button"), on = event.target === canvas;
        const keys = {
            " ": button ? null : () => play(!playing), Home: () => goTo(state.first), End: () => goTo(state.last),
            ArrowLeft: () => (event.shiftKey && on ? turn(-0.1, 0) : goTo(wanted - 1)), ArrowRight: () => (event.shiftKey && on ? turn(0.1, 0) : goTo(wanted + 1)),
            ArrowUp: on ? () => turn(0, 0.1) : null, ArrowDown: on ? () => turn(0, -0.1) : null, "+": () => nearer(0.9), "-": () => nearer(1 / 0.9),
            1: () => setLayer("paper"), 2: () => setLayer("temperature"), 3: () => setLayer("char"), 4: () => setLayer("strain"), 5: () => setLayer("gas"),
            6: () => setLayer("contact"), 7: () => setLayer("strands"),
            c: goHome, f: () => setFire(!stage.fire), p: saveStill, v: saveFilm, b: () => openBranch($("branching").hidden), l: () => state.live && follow(!following), Escape: forget,
        };
        const act = keys[event.key];
        if (act) { event.preventDefault(); act(); }
    });
    new ResizeObserver(() => { fit(); showFacts(); }).observe(canvas);
    canvas.addEventListener("webglcontextlost", (event) => { event.preventDefault(); stop("The graphics card lost its memory. Load the page again."); });
}

function fit() {
    const scale = pixels.share * Math.min(devicePixelRatio || 1, 2), w = Math.round(canvas.clientWidth * scale), h = Math.round(canvas.clientHeight * scale);
    if (w !== canvas.width || h !== canvas.height) { stage.resize(w, h); dirty = true; }
}

/** @param {boolean} whole in all pixels @param {number} now the screen's frame, where it is drawn for one */
function draw(whole, now = performance.now()) {
    pixels.begin(now, whole);
    fit();
    dirty = false;
    stage.draw(camera);
    pixels.end();
}

function tick(now) {
    pixels.tick(now);
    if (playing && room && shown === wanted && !busy) {
        const step = 1000 / room.fps;
        if (now - played >= step) {
            played = now - played > 4 * step ? now : played + step;
            if (shown >= state.last) { if (!state.live) play(false); }
            else advanceTo(shown + 1);
        }
        if (shown < state.last && !kept.has(shown + 2) && shown + 2 <= state.last) frameOf(shown + 2).catch(() => {});
    }
    const still = !dirty && pixels.rests(now);
    if ((dirty && pixels.free || still) && room && camera && stage.frame) {
        draw(still, now);
        const mark = $("mark"), at = picked?.at ? stage.project(camera, picked.at) : null;
        mark.hidden = !at;
        if (at) { mark.style.left = `${at[0]}px`; mark.style.top = `${at[1]}px`; }
    }
    requestAnimationFrame(tick);
}

try {
    stage = new Stage(canvas);
    pixels = new Pixels(stage.gl);
    bind();
    setLayer("paper");
    fit();
    look();
    requestAnimationFrame(tick);
    // for tests and the console
    globalThis.view = {
        stage, goTo: async (n) => { play(false); follow(false); await advanceTo(n); }, quality: (q) => { pixels.fixed = q; fit(); }, pickAt, play,
        get state() { return { ...state, shown, busy, playing, picked: picked && { source: picked.source, frames: picked.series.size }, kept: kept.size, stats: stats.length }; },
        get camera() { return camera; },
    };
} catch (error) {
    stop(error.message);
}
