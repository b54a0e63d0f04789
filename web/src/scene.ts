// What is burnt, and how: the settings of the page, in its link, and as a scene for `singe run`.

/** What a match or, with its direction, a breath did: where it was when, m and s. */
export interface Stroke { start: number; end: number; path: { time: number; position: [number, number, number] }[]; direction?: Point }
export type Point = [number, number, number];

export type Place = "table" | "hung" | "ball";

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

export const MATERIALS: Record<string, string> = {
    "office-paper": "Office paper", newsprint: "Newsprint", tissue: "Tissue", cotton: "Cotton",
};

export const BALL = { at: [0, 0, 0.055] as Point, radius: 0.055 };
const HUNG = 0.19; // m, height of the middle of a sheet that hangs

/** Where the sheet begins, what holds it, and the match that the page strikes. */
export const PLACES: Record<Place, { label: string; rotate: Point; translate: Point; pins: Point[]; match: Point; flat: boolean }> = {
    table: { label: "On the table", rotate: [0, 0, 0], translate: [0, 0, 0.0005], pins: [], match: [0.03, -0.045, 0], flat: true },
    hung: {
        label: "Hung up", rotate: [Math.PI / 2, 0, 0], translate: [0, 0, HUNG], match: [0.02, 0, HUNG - 0.148], flat: false,
        pins: [-0.1, 0, 0.1].map((x) => [x, 0, HUNG + 0.148]),
    },
    ball: { label: "Over a ball", rotate: [0, 0, 0], translate: [0.004, 0.006, 0.118], pins: [], match: [0.05, -0.03, 0.118], flat: true },
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

/** A4, m. */
export const SHEET = { width: 0.21, height: 0.297 };
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
    };
}

export function materialOptions(s: Settings) {
    const uneven = { from: 4e-3, to: 10e-3, noise: { scale: 0.03, octaves: 5, seed: s.seed } };
    return { base: s.material, thickness: s.thickness, ...(s.material === "office-paper" ? { mass_rate: uneven } : {}) };
}

export function gridOf(s: Settings) {
    return {
        size: [SHEET.width, SHEET.height] as const, cells: [s.cells, Math.round((s.cells * SHEET.height) / SHEET.width)] as const,
        seed: s.seed,
    };
}

// ---- the link

/** Only what differs from the standard, and the strokes of the match and the breath in mm and ms. */
export function toLink(s: Settings, strokes: Stroke[], pins: Point[]): string {
    const parts = new URLSearchParams();
    for (const key of Object.keys(STANDARD) as (keyof Settings)[])
        if (s[key] !== STANDARD[key]) parts.set(key, String(s[key]));
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
    const parts = new URLSearchParams(text), settings = { ...STANDARD };
    const number = (key: Slider) => {
        const value = Number(parts.get(key)), { least, most } = RANGES[key];
        if (parts.has(key) && value >= least && value <= most) settings[key] = value;
    };
    (Object.keys(RANGES) as Slider[]).forEach(number);
    settings.cells = Math.round(settings.cells);
    settings.seed = Math.round(settings.seed);
    if (Object.keys(MATERIALS).includes(parts.get("material") ?? "")) settings.material = parts.get("material")!;
    if (Object.keys(PLACES).includes(parts.get("place") ?? "")) settings.place = parts.get("place") as Place;
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
    const grid = gridOf(s), where = PLACES[mesh ? "table" : s.place], list = (numbers: readonly number[]) => `[${numbers.map((x) => +x.toFixed(6)).join(", ")}]`;
    const frames = Math.max(2, Math.ceil(24 * seconds) + 1);
    const lines = [
        "# Made by Singe's page: singe run scene.yaml -o out",
        "# For finer cells raise `cells` and `steps` together.",
        ...(skipped ? ["# The hand is not in here: scenes have no such object."] : []),
        `frames: ${frames}`, "fps: 24", `steps: ${Math.round(1 / (24 * TIME_STEP))}`, `pace: ${s.pace}`, `seed: ${s.seed}`,
        `gravity: ${list([0, 0, -G * s.gravity])}`, "detail: 1.5 mm", "raggedness: 2 mm",
        "solver: {substeps: 4}", "tearing: yes", "creases: no", "contact: {enabled: no}",
        ...(s.gas ? ["gas: {enabled: yes, cell_size: 11.5 mm, height: 20 cm}"] : ["gas: {enabled: no}"]),
        ...(s.wind ? [`wind: {velocity: ${list([s.wind, 0, 0])}, gust: ${+(0.4 * Math.abs(s.wind)).toFixed(3)}, seed: ${s.seed}}`] : []),
        "sheets:", "  - name: sheet",
        mesh ? `    mesh: ${JSON.stringify(mesh)} # the file that was dropped; the page scales it to 25 cm`
            : `    grid: {size: ${list(grid.size)}, cells: [${grid.cells.join(", ")}], seed: ${s.seed}}`,
        ...(where.flat ? [] : [`    rotate: ${list(where.rotate.map((angle) => (angle * 180) / Math.PI))}`]),
        `    translate: ${list(where.translate)}`, "    drop_pieces_below: 4 mm2", "    material:", `      base: ${s.material}`, `      thickness: ${s.thickness}`,
        ...(s.material === "office-paper" ? [`      mass_rate: {from: 4e-3, to: 10e-3, noise: {scale: 3 cm, octaves: 5, seed: ${s.seed}}}`] : []),
        ...(strokes.length ? ["sources:"] : []),
        ...strokes.flatMap(({ start, end, path, direction }) => [
            `  - {kind: ${direction ? "jet" : "ball"}, start: ${start.toFixed(3)}, end: ${end.toFixed(3)}, ` +
                (direction ? `direction: ${list(direction)}, radius: ${BREATH.radius}, speed: ${BREATH.speed},`
                    : `radius: ${MATCH.radius}, falloff: ${MATCH.falloff}, temperature: ${MATCH.temperature},`),
            `     path: [${path.map((key) => `{time: ${key.time.toFixed(3)}, position: ${list(key.position)}}`).join(", ")}]}`]),
        "colliders:", "  - {kind: plane, friction: 0.4, offset: 0.5 mm}",
        ...(!mesh && s.place === "ball" ? [`  - {kind: sphere, position: ${list(BALL.at)}, radius: ${BALL.radius}, friction: 0.4, offset: 0.5 mm}`] : []),
        ...(pins.length ? ["pins:", `  - {sheet: sheet, points: [${pins.map(list).join(", ")}], radius: 5 mm}`] : []),
        "preview:", "  ground: {height: 0, colour: [0.20, 0.105, 0.052]}",
    ];
    return lines.join("\n") + "\n";
}

/** A match's flame. */
export const MATCH = { radius: 0.01, falloff: 0.015, temperature: 1123 };

/** A mouth, and how far it is from what it blows on, m; m/s. */
export const BREATH = { radius: 0.03, speed: 8 };
export const MOUTH = 0.15;

export const sourceOf = ({ start, end, path, direction }: Stroke) =>
    direction ? { kind: "jet" as const, start, end, path, direction, ...BREATH } : { kind: "ball" as const, start, end, path, ...MATCH };
