// The page: input, settings, and one request for a frame after another.
import { MOUSE, Plane, Raycaster, TOUCH, Triangle, Vector2, Vector3 } from "three";
import { loadFiles, type Files } from "singe";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { AIRBORNE_FLOATS } from "../view/airborne.js";
import { Pixels } from "../view/pixels.js";
import { FLOATS } from "./fields.js";
import { glbOf } from "./glb.js";
import { MARKS, type Frame, type FromWorker, type Shape, type ToWorker } from "./messages.js";
import { Print } from "./print.js";
import { CONTEXT, Renderer } from "./renderer.js";
import { placed } from "./shape.js";
import { FireSound } from "./sound.js";
import { PLACES, placeOf, type Place, type Point, type Sides } from "./places.js";
import { fromLink, MATERIALS, RANGES, standardOf, TIME_STEP, toLink, toYaml, type Settings, type Slider } from "./scene.js";

const TOOLS = ["match", "breath", "hand", "pin", "pen"] as const; // in the order of their keys
type Tool = (typeof TOOLS)[number];
const LIVE: Slider[] = ["pace", "wind", "gravity"];
const LONGEST_FRAME = 1 / 10; // s of motion in a frame
const BUDGET = { least: 45, most: 250 }; // ms of computing in a frame, more where drawing takes long
const FILE_MOST = 30e6; // bytes
const MESH_SIZE: [number, number] = [0.25, 0.25]; // m, of all that is dropped
const SECOND_FINGER = { wait: 90, slip: 8 }; // ms and px for which the first does nothing, as two turn the view
const TOOLS_HEIGHT = 100; // px at the bottom, with what is around them
const PAPER: Point = [0.86, 0.852, 0.832]; // linear, as in shaders.js
const HINTS: Record<Tool, string> = {
    match: "Drag the match over the paper", breath: "Hold to blow the fire out", hand: "Take the paper, pull, and tear it",
    pin: "Click to pin the paper to the table; click a pin to take it out",
    pen: "Write on the paper",
};
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;

const element = <Kind extends HTMLElement>(query: string) => document.querySelector<Kind>(query)!;
const canvas = element<HTMLCanvasElement>("#view"), hint = element("#hint"), ring = element("#at"), facts = element("#facts");
const form = element<HTMLFormElement>("#settings"), menu = element<HTMLSelectElement>("header select");
const print = new Print();

let { settings, strokes: linkedStrokes, pins: linkedPins } = fromLink(location.hash.slice(1));
let shape: Shape | null = null, shapeName: string | null = null;
let tool: Tool = "match", paused = still, busy = true, begun = false;
let frame: Frame | null = null;
let pointer: { id: number; x: number; y: number } | null = null, applying = false;
let own = true; // what is printed is the scene's own picture, not one that was dropped
let marked: number[] = []; // lines written, at each mark of the worker
let grabbed: { plane: Plane; to: Point } | null = null;
let keyAt: Point = [0, -0.02, 0.002], keyHeld = false;
let last = performance.now(), costOfStep = 4, speed = 1, motion = 0; // motion: s, of the last frame
let scale = 0, stale = false, unseen = false, burns = false; // what is drawn, and what is not yet

// ---- what the page needs

function stop(title: string, text: string): void {
    const box = element("#stop");
    box.hidden = false;
    box.replaceChildren(Object.assign(document.createElement("strong"), { textContent: title }), Object.assign(document.createElement("p"), { textContent: text }));
}

/** A module of one instruction of simd128. */
const SIMD = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

function lacking(): [string, string] | null {
    if (typeof WebAssembly === "undefined" || !WebAssembly.validate(SIMD))
        return ["This browser cannot compute the fire.", "Singe needs WebAssembly with simd128, which browsers have had since 2021 (Safari since 2023). An update brings it."];
    const gl = canvas.getContext("webgl2", CONTEXT);
    if (!gl) return ["This browser cannot draw the fire.", "Singe needs WebGL 2. It may be switched off, or the card's driver may be blocked: see the browser's page about its graphics."];
    if (!gl.getExtension("EXT_color_buffer_float")) return ["This graphics card cannot draw the fire.", "Singe needs render targets of floating point (EXT_color_buffer_float)."];
    return null;
}

// it loads the core while this thread prepares the card
const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
send({ kind: "load", wasm: new URL("./singe.wasm", import.meta.url).href });
const lack = lacking();
let renderer: Renderer, controls: OrbitControls, pixels: Pixels;
if (!lack) start();
else {
    worker.terminate();
    stop(...lack);
}

function start(): void {
    renderer = new Renderer(canvas);
    pixels = new Pixels(canvas.getContext("webgl2")!);
    controls = new OrbitControls(renderer.camera, canvas);
    controls.mouseButtons = { LEFT: null, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.ROTATE };
    controls.touches = { ONE: null, TWO: TOUCH.DOLLY_ROTATE };
    controls.enablePan = false;
    controls.minDistance = 0.12;
    controls.maxDistance = 1.1;
    controls.maxPolarAngle = 1.52;
    controls.enableDamping = !still;
    controls.addEventListener("change", () => { stale = true; });
    place();
    resize();
    addEventListener("resize", resize);
    canvas.addEventListener("webglcontextlost", (event) => {
        event.preventDefault();
        say("The graphics card has dropped the picture. It comes back when the card does.");
    });
    canvas.addEventListener("webglcontextrestored", () => {
        say("The picture is back");
        stale = unseen = true;
    });
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => hear(data);
    worker.onerror = () => stop("The simulation could not be loaded.", "Its worker failed to start. A reload may help; so may a browser of 2023 or later.");
    printOwn();
    writeSettings();
    chooseTool(settings.place === "blank" ? "pen" : "match", true);
    showPaused();
    requestAnimationFrame(tick);
}

function send(message: ToWorker): void { worker.postMessage(message); }

/** A view of the whole sheet: from further away until its corners are on the screen, above the tools. */
function place(): void {
    const name = shape ? "table" : settings.place, { view: { at, from }, sheets, upright, key } = placeOf(name), { camera } = renderer;
    const { size: [width, height], translate: [, , z] } = sheets[0]!;
    const corners = [-1, 1].flatMap((x) => [-1, 1].map((y) => (upright ? [x * width, 0, 2 * z + y * height] : [x * width, y * height, 0])));
    controls.target.set(...at);
    camera.aspect = innerWidth / innerHeight;
    const up = upright ? 1 : Math.max(1, 2.6 - 2 * camera.aspect); // a tall screen has room for a look from higher up
    camera.updateProjectionMatrix();
    for (let away = 1; away < 3; away *= 1.04) {
        camera.position.set(from[0], from[1], up * from[2]).sub(controls.target).multiplyScalar(away).add(controls.target);
        camera.lookAt(controls.target);
        camera.updateMatrixWorld();
        const places = corners.map((corner) => new Vector3(...corner).multiplyScalar(0.5).project(camera));
        if (places.every(({ x, y }) => Math.abs(x) < 0.97 && y > (2 * TOOLS_HEIGHT) / innerHeight - 1)) break;
    }
    controls.maxDistance = Math.max(1.1, 1.2 * camera.position.distanceTo(controls.target));
    renderer.setPlace(name);
    keyAt = [...key];
    controls.update();
}

/** Whether what burns hangs in the plane of x and z. */
const upright = () => placeOf(shape ? "table" : settings.place).upright;

function resize(): void {
    scale = 0;
    stale = true;
}

// ---- what is printed


function printNow(picture: HTMLImageElement | ImageBitmap | null): void {
    print.set(picture, shape ? MESH_SIZE : placeOf(settings.place).sheets[0]!.size);
    renderer.print(print.canvas, sides());
    stale = true;
}

function sides(): Sides { return shape || settings.material === "cotton" ? "through" : placeOf(settings.place).back ? "both" : "front"; }

/** The pen goes on to what is under a place of the screen. */
function write(x: number, y: number, pressure: number): void {
    const hit = pick(x, y);
    if (!hit?.uv) return;
    const [u, v] = hit.uv;
    print.to(hit.back && sides() === "both" ? 1 - u : u, v, pressure);
    renderer.reprint();
    stale = true;
}

/** Undo comes back to here: the burn by the worker, the writing here. */
function mark(): void {
    send({ kind: "mark" });
    marked.push(print.count);
    if (marked.length > MARKS) marked.shift();
}

/** Prints what the scene has. */
function printOwn(): void {
    own = true;
    const { picture: name } = placeOf(settings.place);
    printNow(null);
    if (!name || shape) return;
    const loaded = new Image();
    loaded.onload = () => {
        if (own && !shape && placeOf(settings.place).picture === name && !print.count) printNow(loaded);
    };
    loaded.src = name;
}

// ---- frames

function restart(): void {
    busy = true;
    marked = [];
    renderer.setSides(sides());
    send({ kind: "begin", settings: shape ? { ...settings, place: "table" } : settings, shape, strokes: linkedStrokes, pins: linkedPins });
}

function hear(message: FromWorker): void {
    if (message.kind === "loaded") return restart();
    if (message.kind === "failed") {
        busy = false;
        if (!begun) return stop("The simulation could not begin.", message.message);
        return say(`Singe refused this: ${message.message}`);
    }
    if (message.kind === "begun") {
        begun = true;
        linkedStrokes = [];
        linkedPins = [];
        return;
    }
    if (message.kind === "surface")
        return void files().then((writer) => save(new Blob([writer.writeUsdc(message.surface, "singe", PAPER)], { type: "model/vnd.usd" }), "singe.usdc"));
    frame = message;
    busy = false;
    motion = message.steps * TIME_STEP;
    sound?.fire.hear(message.burning, message.tears, motion);
    made += message.steps;
    if (message.steps) costOfStep += 0.2 * (message.ms / message.steps - costOfStep);
    unseen = true;
    if (!paused) stale = true;
    else if (!stepping) draw();
    element<HTMLButtonElement>("#undo").disabled = !message.marks;
    waiting.splice(0).forEach((resolve) => resolve());
}

const waiting: (() => void)[] = [];
let stepping = false;

/** Asks for `seconds` of motion, if the worker is not at work already. */
function advance(seconds: number, most: number): void {
    busy = true;
    const at = applying ? target() : null;
    send({
        kind: "advance", seconds, most, match: at && tool === "match" ? at : null,
        breath: at && tool === "breath" ? { at, direction: breathDirection(at) } : null, hand: grabbed ? grabbed.to : null,
    });
}

function tick(now: number): void {
    requestAnimationFrame(tick);
    pixels.tick(now);
    const passed = (now - last) / 1000;
    controls.update();
    if (!busy && begun && !paused && !document.hidden) {
        last = now;
        const budget = Math.min(Math.max(1000 * passed, BUDGET.least), BUDGET.most);
        speed += 0.3 * (motion / Math.max(passed, 1e-3) - speed);
        advance(Math.min(passed, LONGEST_FRAME), Math.max(1, Math.floor(budget / costOfStep)));
    } else if (paused) {
        last = now;
    }
    if (stale && pixels.free) draw(false, now);
    else if (pixels.rests(now)) draw(true, now);
}

let made = 0; // steps
/** Draws the newest frame. @param whole in all pixels @param now the screen's frame, where it is drawn for one */
function draw(whole = false, now = performance.now()): void {
    pixels.begin(now, whole);
    stale = false;
    const wanted = pixels.fixed ?? Math.min(devicePixelRatio, 1.5) * pixels.share;
    if (wanted !== scale) {
        scale = wanted;
        renderer.resize(innerWidth, innerHeight, scale);
    }
    if (frame && unseen) {
        unseen = false;
        renderer.show(frame);
        showFacts(frame);
    }
    renderer.setMatch(applying && tool === "match" ? target() : keyHeld && tool === "match" ? keyAt : frame?.match ?? null);
    renderer.draw();
    const begins = !burns && frame !== null && frame.burning > 0;
    burns = frame !== null && frame.burning > 0;
    pixels.end(begins ? () => performance.mark("it burns", { detail: frame!.time }) : null);
    if (frame) canvas.classList.add("ready");
}

// ---- pointing

const caster = new Raycaster(), table = new Plane(new Vector3(0, 0, 1), 0);

function rayAt(x: number, y: number): void {
    caster.setFromCamera(new Vector2((2 * x) / innerWidth - 1, 1 - (2 * y) / innerHeight), renderer.camera);
}

interface Hit { at: Point; rest: Point | null; uv?: [number, number]; back?: boolean }

/** The sheet under a place of the screen, or else the table. */
function pick(x: number, y: number): Hit | null {
    rayAt(x, y);
    const { origin, direction } = caster.ray;
    if (frame) {
        const { vertices, triangles } = frame, a = new Vector3(), b = new Vector3(), c = new Vector3(), at = new Vector3();
        let nearest = Infinity, found: Hit | null = null;
        for (let t = 0; t < triangles.length; t += 3) {
            const [i, j, k] = [triangles[t]! * FLOATS, triangles[t + 1]! * FLOATS, triangles[t + 2]! * FLOATS];
            if (!caster.ray.intersectTriangle(a.fromArray(vertices, i), b.fromArray(vertices, j), c.fromArray(vertices, k), false, at)) continue;
            const distance = at.distanceTo(origin);
            if (distance < nearest) {
                nearest = distance;
                const share = Triangle.getBarycoord(at, a, b, c, new Vector3()) ?? new Vector3(1, 0, 0);
                const here = (r: number) => share.x * vertices[i + r]! + share.y * vertices[j + r]! + share.z * vertices[k + r]!;
                const [p, q] = [j, k].map((to) => [vertices[to + 9]! - vertices[i + 9]!, vertices[to + 10]! - vertices[i + 10]!] as const);
                const turn = (p![0] * q![1] - p![1] * q![0]) * b.sub(a).cross(c.sub(a)).dot(direction);
                found = { at: at.toArray() as Point, rest: [here(6), here(7), here(8)], uv: [here(9), here(10)], back: turn > 0 };
            }
        }
        if (found) return found;
    }
    const at = caster.ray.intersectPlane(table, new Vector3());
    return at && at.length() < 0.6 && direction.z < 0 ? { at: at.toArray() as Point, rest: null } : null;
}

/** Where the tool works now: at the pointer, or at the keyboard's place. */
function target(): Point | null {
    if (!pointer) return keyHeld ? keyAt : null;
    const hit = pick(pointer.x, pointer.y);
    return hit ? [hit.at[0], hit.at[1], hit.at[2] + 0.003] : null;
}

function breathDirection(at: Point): Point {
    const ahead = new Vector3(...at).sub(renderer.camera.position).setZ(0).normalize();
    return ahead.setZ(upright() ? -0.1 : -0.7).normalize().toArray() as Point; // onto the table
}

function beginUse(hit: Hit | null): void {
    if (!frame || !hit) return;
    say("");
    const near = frame.pins.findIndex((pin) => Math.hypot(pin[0] - hit.at[0], pin[1] - hit.at[1], pin[2] - hit.at[2]) < 0.009);
    if (tool === "pin") {
        mark();
        if (near >= 0) send({ kind: "unpin", index: near });
        else if (hit.rest) send({ kind: "pin", rest: hit.rest });
        else say("A pin needs paper under it");
        refresh();
        return;
    }
    if ((tool === "hand" || tool === "pen") && !hit.rest) return say(`The ${tool} needs paper under it`);
    if (tool === "pen" && hit.back && sides() === "front") return say("The pen writes on the other side");
    mark();
    applying = true;
    if (tool === "pen") return print.begin();
    if (tool === "hand") {
        const normal = renderer.camera.getWorldDirection(new Vector3()).negate();
        grabbed = { plane: new Plane().setFromNormalAndCoplanarPoint(normal, new Vector3(...hit.at)), to: hit.at };
        send({ kind: "grab", rest: hit.rest!, at: hit.at });
        canvas.classList.add("held");
    }
    if (paused) pause(false);
}

function moveUse(): void {
    if (!grabbed || !pointer) return;
    rayAt(pointer.x, pointer.y);
    const to = caster.ray.intersectPlane(grabbed.plane, new Vector3());
    if (to) grabbed.to = [to.x, to.y, Math.max(to.z, 0.003)];
}

function endUse(): void {
    if (grabbed) send({ kind: "release" });
    grabbed = null;
    applying = false;
    canvas.classList.remove("held");
    writeLink();
}

/** Shows a change that comes without motion. */
function refresh(): void { if (!busy) advance(0, 0); }

const writing = () => applying && tool === "pen";
const pressureOf = ({ pointerType, pressure }: PointerEvent) => (pointerType === "pen" ? pressure : 0.5);

const down = new Set<number>();
let early: { timer: number; begin: () => void } | null = null; // a first finger that a second may follow

/** The finger, or what points, is at work alone; a second finger comes too late. */
function beginEarly(): void {
    if (!early) return;
    clearTimeout(early.timer);
    const { begin } = early;
    early = null;
    begin();
}

canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    ring.hidden = true;
    down.add(event.pointerId);
    if (event.button !== 0 || down.size > 1) { // two fingers turn the view
        clearTimeout(early?.timer);
        early = null;
        if (applying) endUse();
        pointer = null;
        return;
    }
    pointer = { id: event.pointerId, x: event.clientX, y: event.clientY };
    canvas.setPointerCapture(event.pointerId);
    const begin = () => {
        beginUse(pick(event.clientX, event.clientY));
        if (writing()) write(event.clientX, event.clientY, pressureOf(event));
    };
    early = { timer: window.setTimeout(beginEarly, SECOND_FINGER.wait), begin };
    if (event.pointerType !== "touch") beginEarly();
});
canvas.addEventListener("pointermove", (event) => {
    if (pointer?.id !== event.pointerId) return;
    if (early && Math.hypot(event.clientX - pointer.x, event.clientY - pointer.y) < SECOND_FINGER.slip) return;
    beginEarly();
    pointer = { id: event.pointerId, x: event.clientX, y: event.clientY };
    stale = applying;
    if (writing()) for (const one of event.getCoalescedEvents?.() ?? [event]) write(one.clientX, one.clientY, pressureOf(one));
    moveUse();
});
for (const name of ["pointerup", "pointercancel"] as const)
    canvas.addEventListener(name, (event) => {
        down.delete(event.pointerId);
        if (pointer?.id !== event.pointerId) return;
        if (name === "pointerup") beginEarly(); // a tap
        if (applying) endUse();
        pointer = null;
    });
canvas.addEventListener("blur", () => { ring.hidden = true; });
canvas.addEventListener("contextmenu", (event) => event.preventDefault());

// ---- keys

const STEP = 0.005; // m a key press moves the tool
const MOVES: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

addEventListener("keydown", (event) => {
    const inForm = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
    if (lack || inForm || event.ctrlKey && event.key !== "z" || event.metaKey || event.altKey) return;
    const move = MOVES[event.key], onView = event.target === canvas || event.target === document.body;
    if (move && onView && event.shiftKey) turn(0.08 * move[0], 0.05 * move[1]);
    else if (move && onView) moveKey(STEP * move[0], STEP * move[1]);
    else if (event.key === "Enter" && onView && !event.repeat) useKey();
    else if (event.key === " " && onView) pause(!paused);
    else if (event.key === "Escape") { keyHeld = false; if (applying) endUse(); }
    else if ("12345".includes(event.key)) chooseTool(TOOLS[Number(event.key) - 1]!);
    else if (event.key === "z") undo();
    else if (event.key === "r") again();
    else if (event.key === "s") element<HTMLDetailsElement>(".panel").toggleAttribute("open");
    else return;
    event.preventDefault();
});

function turn(aside: number, up: number): void {
    const { camera } = renderer, offset = camera.position.clone().sub(controls.target);
    offset.applyAxisAngle(new Vector3(0, 0, 1), -aside);
    offset.applyAxisAngle(new Vector3(0, 0, 1).cross(offset).normalize(), -up);
    if (offset.z > 0.02 && Math.hypot(offset.x, offset.y) > 0.05) camera.position.copy(controls.target).add(offset);
    camera.lookAt(controls.target);
    if (!ring.hidden) showKey();
    stale = true;
}

function moveKey(x: number, y: number): void {
    const within = (value: number, least: number, most: number) => Math.max(least, Math.min(most, value)), across = within(keyAt[0] + x, -0.2, 0.2);
    keyAt = upright() ? [across, keyAt[1], within(keyAt[2] + y, 0, 0.4)] : [across, within(keyAt[1] + y, -0.2, 0.2), keyAt[2]];
    if (grabbed) grabbed.to = [grabbed.to[0] + x, grabbed.to[1] + y, grabbed.to[2] + Math.abs(y)];
    if (writing()) write(...keyOnScreen(), 0.5);
    showKey();
    say(`${tool} at ${Math.round(1000 * keyAt[0])}, ${Math.round(1000 * keyAt[1])} mm: Enter ${keyHeld ? "ends" : "begins"}`);
}

function keyOnScreen(): [number, number] {
    const screen = new Vector3(...keyAt).project(renderer.camera);
    return [((screen.x + 1) / 2) * innerWidth, ((1 - screen.y) / 2) * innerHeight];
}

/** A ring where the keyboard's tool is. */
function showKey(): void {
    const [x, y] = keyOnScreen();
    ring.hidden = false;
    ring.style.translate = `${x}px ${y}px`;
}

/** Enter begins what the tool does at the keyboard's place, and ends it. */
function useKey(): void {
    if (keyHeld) {
        keyHeld = false;
        return endUse();
    }
    keyHeld = tool !== "pin";
    beginUse(pick(...keyOnScreen()));
    keyHeld &&= applying;
    if (writing()) write(...keyOnScreen(), 0.5);
    showKey();
}

// ---- buttons

function chooseTool(wanted: Tool, quiet = false): void {
    tool = wanted;
    document.querySelectorAll<HTMLElement>("[data-tool]").forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.tool === wanted)));
    canvas.className = `${canvas.classList.contains("ready") ? "ready " : ""}${wanted}`;
    const more = quiet ? ". The right button, or two fingers, turn the view" : wanted === "pen" && frame?.burnt ? ". New brings one that does not burn" : "";
    say(HINTS[wanted] + more);
}

let sound: { context: AudioContext; fire: FireSound } | null = null;

function setSound(wanted: boolean): void {
    void sound?.context.close();
    const context = wanted ? new AudioContext() : null;
    sound = context && { context, fire: new FireSound(context) };
    if (paused) void context?.suspend();
}
element<HTMLInputElement>("#sound").addEventListener("change", ({ target }) => setSound((target as HTMLInputElement).checked));

function pause(wanted: boolean): void {
    paused = wanted;
    void (paused ? sound?.context.suspend() : sound?.context.resume());
    last = performance.now();
    showPaused();
}

function showPaused(): void {
    const button = element<HTMLButtonElement>("#pause");
    button.setAttribute("aria-pressed", String(paused));
    button.querySelector("span")!.textContent = paused ? "Play" : "Pause";
}

function undo(): void {
    if (!frame?.marks || busy && !begun) return;
    endUse();
    send({ kind: "undo" });
    const lines = marked.pop();
    if (lines === undefined) return;
    print.keep(lines);
    renderer.reprint();
}

function again(): void {
    endUse();
    settings = { ...settings, begin: false };
    restart();
    print.keep(0);
    renderer.reprint();
    say("A new sheet. Strike a match");
    writeLink();
}

document.querySelectorAll<HTMLButtonElement>("[data-tool]").forEach((button) => button.addEventListener("click", () => chooseTool(button.dataset.tool as Tool)));
element("#pause").addEventListener("click", () => pause(!paused));
element("#undo").addEventListener("click", undo);
element("#again").addEventListener("click", again);

let silence = 0;
function say(text: string): void {
    hint.textContent = text;
    clearTimeout(silence);
    if (text) silence = window.setTimeout(() => { hint.textContent = ""; }, 6000);
}

// ---- settings

function writeSettings(): void {
    element("#live").querySelectorAll("label").forEach((row) => row.remove());
    element("#fresh").querySelectorAll("label").forEach((row) => row.remove());
    const choices = { material: Object.entries(MATERIALS), place: Object.entries(PLACES).map(([value, { label }]) => [value, label] as const) };
    for (const [name, options] of Object.entries(choices)) {
        const select = form.elements.namedItem(name) as HTMLSelectElement;
        select.replaceChildren(...options.map(([value, text]) => new Option(text, value, false, value === settings[name as keyof typeof choices])));
    }
    for (const key of Object.keys(RANGES) as Slider[]) {
        const { label, least, most, step, text } = RANGES[key], row = document.createElement("label");
        row.innerHTML = `${label} <output></output><input type="range" name="${key}" min="${least}" max="${most}" step="${step}">`;
        const input = row.querySelector("input")!;
        input.value = String(settings[key]);
        row.querySelector("output")!.textContent = text(settings[key]);
        element(LIVE.includes(key) ? "#live" : "#fresh").append(row);
    }
    (form.elements.namedItem("gas") as HTMLInputElement).checked = settings.gas;
}

function takeInput({ target }: Event): void {
    const input = target as HTMLInputElement, key = input.name as keyof Settings;
    if (!(key in settings)) return;
    const value = target instanceof HTMLSelectElement ? input.value : key === "gas" ? input.checked : Number(input.value);
    settings = { ...settings, [key]: value };
    if (key in RANGES) input.closest("label")!.querySelector("output")!.textContent = RANGES[key as Slider].text(Number(value));
    if (LIVE.includes(key as Slider) && !(key === "gravity" && settings.gas)) send({ kind: "set", settings });
}

function takeChange({ target }: Event): void {
    const key = (target as HTMLInputElement).name;
    if (!(key in settings)) return;
    if (key === "place") changePlace(settings.place);
    if (!LIVE.includes(key as Slider) || (key === "gravity" && settings.gas)) restart(); // gravity is the gas's, too
    writeLink();
}

/** A scene begins as it is meant: what it sets, and what the one before set, is not kept. */
function changePlace(next: Place): void {
    const standard = standardOf(next);
    shape = shapeName = null;
    settings = { ...standard, cells: settings.cells, seed: settings.seed, gravity: settings.gravity, gas: settings.gas };
    writeSettings();
    place();
    if (own) printOwn();
    else printNow(print.picture);
    chooseTool(next === "blank" ? "pen" : tool === "pen" ? "match" : tool);
}

for (const from of [form, menu]) {
    from.addEventListener("input", takeInput);
    from.addEventListener("change", takeChange);
}
form.addEventListener("submit", (event) => event.preventDefault());

function writeLink(): void {
    const hash = toLink(settings, frame?.strokes ?? [], frame?.pinRests ?? []);
    history.replaceState(null, "", hash ? `#${hash}` : location.pathname);
}

function showFacts(now: Frame): void {
    const rows = {
        Time: `${now.time.toFixed(2)} s`, Burnt: `${(100 * now.burnt).toFixed(1)} %`, Hottest: `${Math.round(now.hottest - 273)} °C`,
        Pieces: String(now.pieces), Springs: now.springs.toLocaleString("en"), Memory: `${Math.round(now.memory / 1e6)} MB`, "Of real time": `${Math.round(100 * Math.min(speed, 1))} %`,
    };
    facts.replaceChildren(...Object.entries(rows).flatMap(([name, value]) => [
        Object.assign(document.createElement("dt"), { textContent: name }), Object.assign(document.createElement("dd"), { textContent: value })]));
}

// ---- files in

let loading: Promise<Files> | null = null;

/** The readers and the writer of files, loaded when they are first needed. */
function files(): Promise<Files> {
    loading ??= loadFiles(new URL("./singe-files.wasm", import.meta.url).href);
    loading.catch(() => { loading = null; });
    return loading;
}

async function takeFile(file: File): Promise<void> {
    try {
        if (file.size > FILE_MOST) throw new Error(`it has more than ${FILE_MOST / 1e6} MB`);
        if (/\.(obj|ply|stl|glb|gltf)$/i.test(file.name)) {
            const reader = await files().catch(() => { throw new Error("the reader of meshes could not be loaded"); });
            shape = reader.quads(placed(reader.readMesh(file.name, new Uint8Array(await file.arrayBuffer())), file.name));
            shapeName = file.name;
            printNow(null);
            settings = { ...settings, begin: false };
            menu.selectedIndex = -1; // any scene can be chosen next
            place();
            restart();
            say(`${file.name}: ${shape.positions.length / 3} vertices. Strike a match`);
        } else {
            const picture = await createImageBitmap(file).catch(() => {
                throw new Error("it is neither a picture that this browser reads, nor a mesh (OBJ, PLY, STL, GLB)");
            });
            own = false;
            printNow(picture);
            say(`${file.name} is printed`);
        }
    } catch (error) {
        const { message } = error as Error;
        say(message.startsWith(file.name) ? message : `${file.name} was not taken: ${message}`);
    }
}

element("#open").addEventListener("click", () => element("#file").click());
element<HTMLInputElement>("#file").addEventListener("change", ({ target }) => {
    const input = target as HTMLInputElement;
    if (input.files?.[0]) void takeFile(input.files[0]);
    input.value = "";
});
addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("drop"); });
addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("drop"); });
addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("drop");
    const file = event.dataTransfer?.files[0];
    if (file) void takeFile(file);
});

// ---- files out

function save(blob: Blob, name: string): void {
    const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

let recorder: MediaRecorder | null = null;
const SAVES: Record<string, () => void> = {
    png: () => { draw(true); canvas.toBlob((blob) => blob && save(blob, "singe.png")); },
    glb: () => print.canvas.toBlob(async (blob) => {
        if (frame && blob) save(new Blob([glbOf(frame, new Uint8Array(await blob.arrayBuffer()))], { type: "model/gltf-binary" }), "singe.glb");
    }),
    usdc: () => {
        void files().then(() => send({ kind: "surface" }), () => say("The writer of USD could not be loaded"));
    },
    yaml: () => frame && save(new Blob([toYaml(shape ? { ...settings, place: "table" } : settings, frame.strokes, frame.pinRests, frame.time, shapeName, frame.skipped)], { type: "text/yaml" }), "singe.yaml"),
    link: () => {
        writeLink();
        navigator.clipboard?.writeText(location.href).then(() => say("The link is copied: settings, pins, match and breath are in it"), () => say("The link is in the address bar"));
    },
    webm: () => {
        const button = element('[data-save="webm"]');
        if (recorder) return recorder.stop();
        if (typeof MediaRecorder === "undefined" || !MediaRecorder.isTypeSupported("video/webm")) return say("This browser records no WebM");
        const parts: Blob[] = [];
        recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: "video/webm", videoBitsPerSecond: 12e6 });
        recorder.ondataavailable = ({ data }) => parts.push(data);
        recorder.onstop = () => {
            save(new Blob(parts, { type: "video/webm" }), "singe.webm");
            recorder = null;
            pixels.held = false;
            button.textContent = "WebM";
        };
        recorder.start();
        pixels.held = true; // a film has one size
        button.textContent = "Stop";
    },
};
document.querySelectorAll<HTMLElement>("[data-save]").forEach((button) => button.addEventListener("click", () => SAVES[button.dataset.save!]!()));

// ---- for tests: motion by request, without a clock

Object.assign(globalThis, { page: {
    /** Some seconds of motion, in so many frames a second; the clock stands still afterwards. */
    async step(seconds: number, rate = 24): Promise<Omit<Frame, "vertices" | "triangles" | "fire" | "lights" | "airborne">> {
        pause(true);
        const idle = async () => { while (busy) await new Promise<void>((resolve) => { waiting.push(resolve); }); };
        await idle();
        stepping = true; // only the last frame is drawn
        for (let left = Math.round(seconds * rate); left > 0; left--) {
            stepping = left > 1;
            advance(1 / rate, 0);
            await idle();
        }
        stepping = false;
        const { vertices, triangles, fire, lights, airborne, ...rest } = frame!;
        return { ...rest, ...{ vertexCount: vertices.length / FLOATS, triangleCount: triangles.length / 3, flying: airborne.length / AIRBORNE_FLOATS } };
    },
    /** Loudness, root mean square, of a second in which so many cells burn. */
    async loudness(burning: number): Promise<number> {
        const context = new OfflineAudioContext(1, 48_000, 48_000);
        new FireSound(context).hear(burning, 0, 1);
        const heard = (await context.startRendering()).getChannelData(0);
        return Math.sqrt(heard.reduce((sum, x) => sum + x * x, 0) / heard.length);
    },
    /** Lets the clock run for some seconds of the wall; how many steps were made then. */
    async run(seconds: number): Promise<number> {
        const before = made;
        pause(false);
        await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
        pause(true);
        return made - before;
    },
    /** ms to show and draw a frame of the worker until the card has done it, the mean of so many. */
    drawn(times: number): number {
        const gl = canvas.getContext("webgl2")!, wait = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        let before = 0;
        for (let i = -1; i < times; i++) { // the first is not counted
            if (i === 0) before = performance.now();
            renderer.show(frame!);
            renderer.draw();
            wait();
        }
        return (performance.now() - before) / times;
    },
    /** Fewer pixels, for machines without a card. */
    quality(share: number | null): void {
        pixels.fixed = share;
        draw();
    },
    get card() { return renderer.card; },
    project: (point: Point) => {
        const at = new Vector3(...point).project(renderer.camera);
        return [((at.x + 1) / 2) * innerWidth, ((1 - at.y) / 2) * innerHeight];
    },
} });
