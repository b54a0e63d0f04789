// The simulation, away from the page's own thread. The page asks for one frame at a time, so nothing queues up.
import { load, type Handle, type Simulation, type Singe } from "singe";
import { fireOf, lightsOf, meshOf, refined } from "./fields.js";
import type { FromWorker, Shape, ToWorker } from "./messages.js";
import { BALL, BREATH, gridOf, MATCH, materialOptions, MOUTH, PLACES, simulationOptions, sourceOf, TIME_STEP, type Point, type Settings, type Stroke } from "./scene.js";

const FAR: Point = [0, 0, 50]; // where an unused match waits
const MARKS = 6;

/** What a mark brings back; the bytes are the simulation's. */
interface Mark { bytes: Uint8Array; strokes: Stroke[]; pins: { rest: Point; handle: Handle }[]; skipped: boolean }

let singe: Singe;
let sim: Simulation | null = null;
let settings: Settings;
let sheet: Handle;
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

self.onmessage = async ({ data }: MessageEvent<ToWorker>) => {
    try {
        await hear(data);
    } catch (error) {
        tell({ kind: "failed", message: error instanceof Error ? error.message : String(error) });
    }
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
    case "pin": pins.push({ rest: message.rest, handle: sim.addPin({ sheet, points: message.rest, radius: 0.005 }) }); return;
    case "unpin": sim.removePin(pins.splice(message.index, 1)[0]!.handle); return;
    case "mark": return mark();
    case "undo": return undo();
    case "surface": return tell({ kind: "surface", surface: sim.draw() }); // posting copies it
    }
}

function begin(wanted: Settings, shape: Shape | null, linked: Stroke[], pinned: Point[]): void {
    const made = singe.create(simulationOptions(wanted)), where = PLACES[shape ? "table" : wanted.place];
    try {
        const material = materialOptions(wanted), place = { rotate: where.rotate, translate: where.translate, drop_pieces_below: 4e-6 };
        const added = shape ? made.addSheet(shape, material, place) : made.addSheet(gridOf(wanted), material, place);
        made.commit();
        sim?.destroy();
        sim = made;
        sheet = added;
    } catch (error) {
        made.destroy(); // the burn before goes on
        throw error;
    }
    settings = wanted;
    sim.addCollider({ kind: "plane", friction: 0.4, offset: 0.0005 });
    if (!shape && wanted.place === "ball") sim.addCollider({ kind: "sphere", position: BALL.at, radius: BALL.radius, friction: 0.4, offset: 0.0005 });
    match = sim.addSource({ kind: "ball", path: still(FAR), ...MATCH });
    hand = jet = null;
    marks = [];
    matchAt = FAR;
    skipped = false;
    stroke = null;
    const first: Stroke = { start: 0, end: 1.25, path: [{ time: 0, position: where.match }] };
    strokes = linked.length ? [...linked] : wanted.begin && !shape ? [first] : [];
    planned = [...strokes];
    for (const one of planned) sim.addSource(sourceOf(one));
    pins = (pinned.length ? pinned : where.pins).map((rest) => ({ rest, handle: sim!.addPin({ sheet, points: rest, radius: 0.005 }) }));
    tell({ kind: "begun", springs: sim.view().spring_count.reduce((a, b) => a + b) });
    frame(0, 0);
}

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
    hand = { handle: sim!.addPin({ sheet, points: rest, radius: 0.009, path: still(at) }), at };
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
    const before = marks.pop();
    if (!before) return;
    const restored = singe.restore(before.bytes);
    sim!.destroy();
    sim = restored;
    ({ strokes, pins, skipped } = before);
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
    const mesh = meshOf(surface, view.time, settings.pace), gas = sim!.gas(), cells = gas ? fireOf(gas, surface) : null;
    const lights = lightsOf(cells, mesh), fire = cells && refined(cells), positions = view.position;
    const places = pins.map(({ rest, handle }) => { // beside the first particle that the pin holds
        const particle = sim!.pinParticles(handle)[0] ?? 0;
        return [0, 1, 2].map((c) => positions[4 * particle + c]! + rest[c]! - view.rest_position[4 * particle + c]!) as Point;
    });
    tell({
        kind: "frame", ...mesh, fire, lights, time: view.time, steps, ms, burnt: stats.burnt_fraction, pieces: stats.pieces, tears: stats.tears,
        springs: stats.springs, hottest: stats.temperature_max, pins: places, match: plannedMatch(view.time), marks: marks.length, skipped,
        memory: singe.memory.memory.buffer.byteLength + marks.reduce((sum, { bytes }) => sum + bytes.length, 0),
        strokes, pinRests: pins.map(({ rest }) => rest),
    }, [mesh.vertices.buffer, mesh.triangles.buffer, lights.buffer, ...(fire ? [fire.cells.buffer] : [])] as Transferable[]);
}
