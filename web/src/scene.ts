// What is burnt, and how: the settings of the page, in its link, and as a scene for `singe run`.
import type { Material } from "singe";
import { BALL, PLACES, placeOf, SHEET, type Place, type Point, type Sheet } from "./places.js";

/** What a match or, with its direction, a breath did: where it was when, m and s. */
export interface Stroke { start: number; end: number; path: { time: number; position: [number, number, number] }[]; direction?: Point }

/** All numbers are SI and kelvin, as in scenes. */
export interface Settings {
    material: string;
    place: Place;
    /** m, the distance between the model's layers */
    thickness: number;
    /** seconds of fire per second of motion */
    pace: number;
    /** m/s along x */
    wind: number;
    /** of the earth's */
    gravity: number;
    /** cells along the short side */
    cells: number;
    seed: number;
    gas: boolean;
    /** the first match, which the page strikes by itself */
    begin: boolean;
}

export const STANDARD: Settings = {
    material: "office-paper", place: "table", thickness: 0.001, pace: 6, wind: 0, gravity: 1, cells: 42, seed: 1, gas: true, begin: true,
};

/** With what a scene begins. */
export const standardOf = (place: Place): Settings => ({ ...STANDARD, place, ...PLACES[place].sets });

export const MATERIALS: Record<string, string> = {
    "office-paper": "Office paper", newsprint: "Newsprint", tissue: "Tissue", cotton: "Cotton",
};

/** Sliders: the least, the most, a step, and how a value reads. */
export const RANGES = {
    pace: { label: "Pace", least: 1, most: 12, step: 0.5, text: (x: number) => `${x}×` },
    wind: { label: "Wind", least: -2, most: 2, step: 0.1, text: (x: number) => `${x.toFixed(1)} m/s` },
    gravity: { label: "Gravity", least: 0, most: 2, step: 0.05, text: (x: number) => `${x.toFixed(2)} g` },
    thickness: { label: "Thickness", least: 0.0005, most: 0.003, step: 0.0001, text: (x: number) => `${(1000 * x).toFixed(1)} mm` },
    cells: { label: "Resolution", least: 20, most: 84, step: 2, text: (x: number) => `${x} cells` },
    seed: { label: "Seed", least: 1, most: 99, step: 1, text: (x: number) => `${x}` },
} as const;
export type Slider = keyof typeof RANGES;

const G = 9.81;

// ---- the simulation that settings ask for

export const TIME_STEP = 1 / 240;

export function simulationOptions(s: Settings) {
    return {
        seed: s.seed, pace: s.pace, time_step: TIME_STEP, gravity: [0, 0, -G * s.gravity] as const,
        surface_detail: 0.0015, surface_raggedness: 0.002,
        wind: { velocity: [s.wind, 0, 0] as const, gust: 0.4 * Math.abs(s.wind), seed: s.seed },
        solver: { substeps: 4, tearing: true },
        gas: { enabled: s.gas, cell_size: 0.0115, height: 0.2 },
        contact: { enabled: !!placeOf(s.place).contact },
    };
}

export function materialOptions(s: Settings): Material {
    const uneven = { from: 4e-3, to: 10e-3, noise: { scale: 0.03, octaves: 5, seed: s.seed } };
    return { base: s.material, thickness: s.thickness, ...(s.material === "office-paper" ? { mass_rate: uneven } : {}), ...placeOf(s.place).change };
}

export function gridOf(s: Settings, { size, fine }: Sheet, index: number) {
    const count = (length: number) => Math.round((s.cells * fine * length) / SHEET.width);
    return { size, cells: [count(size[0]), count(size[1])] as [number, number], seed: s.seed + index };
}

// ---- the link

/** Only what differs from what the scene begins with, and the strokes of the match and the breath in mm and ms. */
export function toLink(s: Settings, strokes: Stroke[], pins: Point[]): string {
    const parts = new URLSearchParams();
    if (s.place !== STANDARD.place) parts.set("place", s.place);
    const standard = standardOf(s.place);
    for (const key of Object.keys(STANDARD) as (keyof Settings)[])
        if (s[key] !== standard[key]) parts.set(key, String(s[key]));
    const mm = (x: number) => Math.round(1000 * x);
    if (pins.length) parts.set("pins", pins.map((pin) => pin.map(mm).join(".")).join("_"));
    const text = ({ direction, path, end }: Stroke) =>
        [...(direction ? [direction.map(mm)] : []), ...path.map((key) => [mm(key.time), ...key.position.map(mm)]), [mm(end)]].map((part) => part.join(".")).join("_");
    for (const [name, kind] of [["match", false], ["breath", true]] as const) {
        const texts = strokes.filter(({ direction }) => !!direction === kind).map(text);
        if (texts.length) parts.set(name, texts.join("~"));
    }
    return parts.toString();
}

export interface Linked { settings: Settings; strokes: Stroke[]; pins: Point[] }

/** What cannot be read is left at its standard: a link may come from anywhere. */
export function fromLink(text: string): Linked {
    const parts = new URLSearchParams(text), wanted = parts.get("place") ?? "";
    const settings = standardOf(Object.hasOwn(PLACES, wanted) ? (wanted as Place) : STANDARD.place);
    const number = (key: Slider) => {
        const value = Number(parts.get(key)), { least, most } = RANGES[key];
        if (parts.has(key) && value >= least && value <= most) settings[key] = value;
    };
    (Object.keys(RANGES) as Slider[]).forEach(number);
    settings.cells = Math.round(settings.cells);
    settings.seed = Math.round(settings.seed);
    if (Object.keys(MATERIALS).includes(parts.get("material") ?? "")) settings.material = parts.get("material")!;
    settings.gas = parts.get("gas") !== "false";
    settings.begin = parts.get("begin") !== "false";
    const millis = (text: string) => text.split(/\.(?=-?\d)/).map((part) => Number(part) / 1000);
    const sound = (numbers: number[], count: number) => numbers.length === count && numbers.every((x) => Math.abs(x) < 100);
    const pins = (parts.get("pins") ?? "").split("_").map(millis).filter((pin) => sound(pin, 3)) as Point[];
    const strokes: Stroke[] = [];
    for (const name of ["match", "breath"] as const)
        for (const stroke of (parts.get(name) ?? "").split("~").slice(0, 50)) {
            const keys = stroke.split("_"), end = Number(keys.pop()) / 1000, path = keys.map(millis), direction = name === "breath" ? path.shift() : null;
            if (!path.length || !path.every((key, i) => sound(key, 4) && (i === 0 || key[0]! > path[i - 1]![0]!)) || !(end > path[0]![0]!)) continue;
            if (direction && !(sound(direction, 3) && Math.hypot(...direction) > 0.1)) continue;
            strokes.push({
                start: path[0]![0]!, end, path: path.map(([time, ...position]) => ({ time: time!, position: position as Point })),
                ...(direction ? { direction: direction as Point } : {}),
            });
        }
    return { settings, strokes, pins };
}

// ---- the scene

/** The same burn for `singe run`: with the strokes of the match, breaths and pins, without hands. */
export function toYaml(s: Settings, strokes: Stroke[], pins: Point[], seconds: number, mesh: string | null, skipped: boolean): string {
    const where = placeOf(s.place), list = (numbers: readonly number[]) => `[${numbers.map((x) => +x.toFixed(6)).join(", ")}]`;
    const frames = Math.max(2, Math.ceil(24 * seconds) + 1);
    const lines = [
        "# Made by Singe's page: singe run scene.yaml -o out",
        "# For finer cells raise `cells` and `steps` together.",
        ...(skipped ? ["# The hand is not in here: scenes have no such object."] : []),
        `frames: ${frames}`, "fps: 24", `steps: ${Math.round(1 / (24 * TIME_STEP))}`, `pace: ${s.pace}`, `seed: ${s.seed}`,
        `gravity: ${list([0, 0, -G * s.gravity])}`, "detail: 1.5 mm", "raggedness: 2 mm",
        "solver: {substeps: 4}", "tearing: yes", "creases: no", `contact: {enabled: ${where.contact ? "yes" : "no"}}`,
        ...(s.gas ? ["gas: {enabled: yes, cell_size: 11.5 mm, height: 20 cm}"] : ["gas: {enabled: no}"]),
        ...(s.wind ? [`wind: {velocity: ${list([s.wind, 0, 0])}, gust: ${+(0.4 * Math.abs(s.wind)).toFixed(3)}, seed: ${s.seed}}`] : []),
        "sheets:", ...where.sheets.flatMap((sheet, i) => sheetLines(s, sheet, i, mesh)),
        ...(strokes.length || where.ember || where.arrival ? ["sources:"] : []),
        ...(where.ember ? [`  - ${flow({ kind: "ball", ...where.ember })}`] : []),
        ...(where.arrival ? [`  - {kind: arrival, texture: ${where.arrival.picture}, from: ${where.arrival.from}, to: ${where.arrival.to}} # of the examples`] : []),
        ...strokes.flatMap(({ start, end, path, direction }) => [
            `  - {kind: ${direction ? "jet" : "ball"}, start: ${start.toFixed(3)}, end: ${end.toFixed(3)}, ` +
                (direction ? `direction: ${list(direction)}, radius: ${BREATH.radius}, speed: ${BREATH.speed},`
                    : `radius: ${MATCH.radius}, falloff: ${MATCH.falloff}, temperature: ${MATCH.temperature},`),
            `     path: [${path.map((key) => `{time: ${key.time.toFixed(3)}, position: ${list(key.position)}}`).join(", ")}]}`]),
        "colliders:", "  - {kind: plane, friction: 0.4, offset: 0.5 mm}",
        ...(where.ball ? [`  - {kind: sphere, position: ${list(BALL.at)}, radius: ${BALL.radius}, friction: 0.4, offset: 0.5 mm}`] : []),
        ...(pins.length || where.hooks ? ["pins:"] : []),
        ...(where.hooks ?? []).map((hook) => `  - ${flow({ ...hook, radius: PIN_RADIUS })}`),
        ...(pins.length ? [`  - {${where.sheets.length > 1 ? "" : "sheet: sheet, "}points: [${pins.map(list).join(", ")}], radius: 5 mm}`] : []),
        "preview:", "  ground: {height: 0, colour: [0.20, 0.105, 0.052]}",
    ];
    return lines.join("\n") + "\n";
}

function sheetLines(s: Settings, sheet: Sheet, index: number, file: string | null): string[] {
    const grid = gridOf(s, sheet, index), { mesh, sheets } = placeOf(s.place), { base, ...material } = materialOptions(s);
    const list = (numbers: readonly number[]) => `[${numbers.map((x) => +x.toFixed(6)).join(", ")}]`;
    return [
        `  - name: sheet${sheets.length > 1 ? index + 1 : ""}`,
        file ? `    mesh: ${JSON.stringify(file)} # the file that was dropped; the page scales it to 25 cm`
            : mesh ? `    mesh: torus.obj # ${mesh.file}`
                : `    grid: {size: ${list(grid.size)}, cells: [${grid.cells.join(", ")}], seed: ${grid.seed}}`,
        ...(sheet.rotate.some((angle) => angle) ? [`    rotate: ${list(sheet.rotate)}`] : []),
        `    translate: ${list(sheet.translate)}`, "    drop_pieces_below: 4 mm2", "    material:", `      base: ${base}`,
        ...Object.entries(material).map(([key, value]) => `      ${key}: ${flow(value)}`),
    ];
}

/** A value as YAML in one line; words that need quotes are not among them. */
const flow = (value: unknown) => JSON.stringify(value).replace(/([,:])/g, "$1 ").replace(/"/g, "");

/** A match's flame. */
export const MATCH = { radius: 0.01, falloff: 0.015, temperature: 1123 };

/** A mouth, and how far it is from what it blows on, m; m/s. */
export const BREATH = { radius: 0.03, speed: 8 };
export const MOUTH = 0.15;

/** What a tack or a hook holds, m. */
export const PIN_RADIUS = 0.005;

export const sourceOf = ({ start, end, path, direction }: Stroke) =>
    direction ? { kind: "jet" as const, start, end, path, direction, ...BREATH } : { kind: "ball" as const, start, end, path, ...MATCH };
