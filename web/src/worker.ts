// The simulation, away from the page's own thread. The page asks for one frame at a time, so nothing queues up.
import { load, type Handle, type Simulation, type Singe, type Texture } from "singe";
import { airborneAt, meshOf } from "./fields.js";
import { fireOf, lightsOf, refined } from "./fire.js";
import { MARKS, type FromWorker, type Shape, type ToWorker } from "./messages.js";
import { BALL, placeOf, type Point, type Where } from "./places.js";
import { BREATH, gridOf, MATCH, materialOptions, MOUTH, PIN_RADIUS, simulationOptions, sourceOf, TIME_STEP, type Settings, type Stroke } from "./scene.js";

const FAR: Point = [0, 0, 50]; // where an unused match waits

/** What a mark brings back; the bytes are the simulation's. */
interface Mark { bytes: Uint8Array; strokes: Stroke[]; pins: { rest: Point; handle: Handle }[]; skipped: boolean }

let singe: Singe;
let sim: Simulation | null = null;
let settings: Settings;
let sheets: Handle[];
let match: Handle;
let jet: { handle: Handle; stroke: Stroke } | null = null;
let hand: { handle: Handle; at: Point } | null = null;
let pins: { rest: Point; handle: Handle }[] = [];
let marks: Mark[] = [];
let planned: Stroke[] = []; // of the link, or the first match
let strokes: Stroke[] = [], stroke: Stroke | null = null;
let matchAt: Point = FAR, skipped = false;

const tell = (message: FromWorker, transfer: Transferable[] = []) => self.postMessage(message, { transfer });
const still = (position: Point) => [{ time: 0, position }];

/** One message after another, also where one waits for a file. */
let before = Promise.resolve();
self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
    before = before.then(() => hear(data)).catch((error: unknown) => tell({ kind: "failed", message: error instanceof Error ? error.message : String(error) }));
};

async function hear(message: ToWorker): Promise<void> {
    if (message.kind === "load") {
        singe = await load(message.wasm);
        return tell({ kind: "loaded", version: singe.version });
    }
    if (message.kind === "begin") return begin(message.settings, message.shape, message.strokes, message.pins);
    if (!sim) return;
    switch (message.kind) {
    case "advance": return advance(message);
    case "set": return change(message.settings);
    case "grab": return grab(message.rest, message.at);
    case "release": return release();
    case "pin": pins.push(pinAt(message.rest)); return;
    case "unpin": sim.removePin(pins.splice(message.index, 1)[0]!.handle); return;
    case "mark": return mark();
    case "undo": return undo();
    case "surface": return tell({ kind: "surface", surface: sim.draw() }); // posting copies it
    }
}

async function begin(wanted: Settings, shape: Shape | null, linked: Stroke[], pinned: Point[]): Promise<void> {
    const where = placeOf(wanted.place), arrival = where.arrival && await greys(where.arrival.picture);
    const made = singe.create(simulationOptions(wanted));
    try {
        const material = materialOptions(wanted), quads = shape ?? where.mesh?.quads;
        const added = where.sheets.map((one, i) => made.addSheet(quads ?? gridOf(wanted, one, i), material, {
            rotate: one.rotate.map((angle) => (angle * Math.PI) / 180) as Point, translate: one.translate, drop_pieces_below: 4e-6,
        }));
        made.commit();
        sim?.destroy();
        sim = made;
        sheets = added;
    } catch (error) {
        made.destroy(); // the burn before goes on
        throw error;
    }
    settings = wanted;
    sim.addCollider({ kind: "plane", friction: 0.4, offset: 0.0005 });
    if (where.ball) sim.addCollider({ kind: "sphere", position: BALL.at, radius: BALL.radius, friction: 0.4, offset: 0.0005 });
    if (where.ember) sim.addSource({ kind: "ball", ...where.ember });
    if (arrival) sim.addSource({ kind: "arrival", texture: arrival, arrival_from: where.arrival!.from, arrival_to: where.arrival!.to });
    match = sim.addSource({ kind: "ball", path: still(FAR), ...MATCH });
    hand = jet = null;
    marks = [];
    matchAt = FAR;
    skipped = false;
    stroke = null;
    strokes = linked.length ? [...linked] : wanted.begin && !shape ? firstOf(where) : [];
    planned = [...strokes];
    for (const one of planned) sim.addSource(sourceOf(one));
    for (const { points, path } of where.hooks ?? []) sim.addPin({ sheet: sheets[0]!, points: points.flat(), radius: PIN_RADIUS, path });
    pins = (pinned.length ? pinned : where.pins).map(pinAt);
    tell({ kind: "begun", springs: sim.view().spring_count.reduce((a, b) => a + b) });
    frame(0, 0);
}

/** The match that the page strikes. */
const firstOf = ({ match: first }: Where): Stroke[] =>
    first ? [{ start: first.start, end: first.end, path: [{ time: first.start, position: first.at }] }] : [];

/** A picture beside the page, its top row first. */
async function greys(name: string): Promise<Texture> {
    const picture = await createImageBitmap(await (await fetch(new URL(name, self.location.href))).blob()), { width, height } = picture;
    const context = new OffscreenCanvas(width, height).getContext("2d")!;
    context.drawImage(picture, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    return { width, height, values: Float32Array.from({ length: width * height }, (_, i) => data[4 * i]! / 255) };
}

/** The sheet that was at this place at rest. */
function sheetAt(rest: Point): Handle {
    if (sheets.length === 1) return sheets[0]!;
    const { rest_position: places, sheet } = sim!.draw();
    let nearest = Infinity, found = 0;
    for (let i = 0; i < sheet.length; i++) {
        const away = Math.hypot(places[3 * i]! - rest[0], places[3 * i + 1]! - rest[1], places[3 * i + 2]! - rest[2]);
        if (away < nearest) [nearest, found] = [away, sheet[i]!];
    }
    return sheets[found]!;
}

const pinAt = (rest: Point) => ({ rest, handle: sim!.addPin({ sheet: sheetAt(rest), points: rest, radius: PIN_RADIUS }) });

function change(wanted: Settings): void {
    settings = { ...settings, pace: wanted.pace, wind: wanted.wind, gravity: wanted.gravity };
    sim!.setPace(settings.pace);
    sim!.setWind(simulationOptions(settings).wind);
    // with gas the largest component may not change
    if (!settings.gas) sim!.setGravity(simulationOptions(settings).gravity);
}

// ---- fire, breath and hand

function moveMatch(at: Point | null, now: number, then: number): void {
    const from = stroke ? matchAt : at ?? FAR;
    sim!.moveSource(match, at ? [{ time: now, position: from }, { time: then, position: at }] : still(FAR));
    if (at && !stroke) strokes.push((stroke = { start: now, end: then, path: [{ time: now, position: at }] }));
    else if (at) extend(stroke!, at, then);
    if (!at) stroke = null;
    matchAt = at ?? FAR;
}

function extend(one: Stroke, position: Point, time: number): void {
    one.end = time;
    if (time > one.path[one.path.length - 1]!.time + 0.05) one.path.push({ time, position });
}

/** A jet from a mouth, which keeps the direction in which it began. */
function blow(wanted: { at: Point; direction: Point } | null, now: number, then: number): void {
    if (!wanted) {
        if (jet) sim!.removeSource(jet.handle);
        jet = null;
        return;
    }
    const direction = jet?.stroke.direction ?? wanted.direction, position = wanted.at.map((x, c) => x - MOUTH * direction[c]!) as Point;
    if (jet) {
        const { path } = jet.stroke;
        sim!.moveSource(jet.handle, [{ time: now, position: path[path.length - 1]!.position }, { time: then, position }]);
        return extend(jet.stroke, position, then);
    }
    const begun: Stroke = { start: now, end: then, path: [{ time: now, position }], direction };
    jet = { handle: sim!.addSource({ kind: "jet", path: still(position), direction, ...BREATH }), stroke: begun };
    strokes.push(begun);
}

function grab(rest: Point, at: Point): void {
    release();
    hand = { handle: sim!.addPin({ sheet: sheetAt(rest), points: rest, radius: 0.009, path: still(at) }), at };
    skipped = true;
}

function release(): void {
    if (hand) sim!.removePin(hand.handle);
    hand = null;
}

// ---- undo

function mark(): void {
    const kept = [...pins];
    marks.push({ bytes: sim!.save(), strokes: strokes.map((one) => ({ ...one, path: [...one.path] })), pins: kept, skipped });
    if (marks.length > MARKS) marks.shift();
}

function undo(): void {
    const last = marks.pop();
    if (!last) return;
    const restored = singe.restore(last.bytes);
    sim!.destroy();
    sim = restored;
    ({ strokes, pins, skipped } = last);
    stroke = hand = jet = null;
    moveMatch(null, 0, 0);
    frame(0, 0);
}

// ---- frames

function advance(message: Extract<ToWorker, { kind: "advance" }>): void {
    const now = sim!.view().time, then = now + Math.max(message.seconds, TIME_STEP), begun = performance.now();
    moveMatch(message.match, now, then);
    blow(message.breath, now, then);
    if (hand && message.hand) {
        sim!.movePin(hand.handle, [{ time: now, position: hand.at }, { time: then, position: message.hand }]);
        hand.at = message.hand;
    }
    const steps = message.seconds > 0 ? sim!.advance(message.seconds, message.most) : 0;
    frame(steps, performance.now() - begun);
}

/** Where a planned stroke holds its match now, to draw it. */
function plannedMatch(time: number): Point | null {
    const now = planned.find(({ start, end, direction }) => !direction && time >= start && time < end);
    if (!now) return null;
    let i = 0;
    while (i + 1 < now.path.length && now.path[i + 1]!.time < time) i++;
    return now.path[i]!.position;
}

function frame(steps: number, ms: number): void {
    const surface = sim!.draw(), view = sim!.view(), stats = sim!.stats();
    const mesh = meshOf(surface, view.time, settings.pace), gas = sim!.gas(), cells = gas ? fireOf(gas, surface, view.time) : null;
    const lights = lightsOf(cells, mesh), airborne = airborneAt(mesh, view.time).slice(), fire = cells && refined(cells), positions = view.position;
    const places = pins.map(({ rest, handle }) => { // beside the first particle that the pin holds
        const particle = sim!.pinParticles(handle)[0] ?? 0;
        return [0, 1, 2].map((c) => positions[4 * particle + c]! + rest[c]! - view.rest_position[4 * particle + c]!) as Point;
    });
    tell({
        kind: "frame", ...mesh, fire, lights, airborne, time: view.time, steps, ms, burnt: stats.burnt_fraction, pieces: stats.pieces, tears: stats.tears,
        springs: stats.springs, hottest: stats.temperature_max, pins: places, match: plannedMatch(view.time), marks: marks.length, skipped,
        memory: singe.memory.memory.buffer.byteLength + marks.reduce((sum, { bytes }) => sum + bytes.length, 0),
        strokes, pinRests: pins.map(({ rest }) => rest),
    }, [mesh.vertices.buffer, mesh.triangles.buffer, lights.buffer, airborne.buffer, ...(fire ? [fire.cells.buffer] : [])] as Transferable[]);
}
