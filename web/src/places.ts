// The scenes of the menu, after our examples and the paper, at a size that burns live: one row is one scene.
import type { Key, Material, Quads } from "singe";

export type Point = [number, number, number];

/** A rectangle of cells: m; degrees about x, then y, then z; m. `fine` cells take the place of one of the letter's. */
export interface Sheet { size: [number, number]; fine: number; rotate: Point; translate: Point }

/** Where a picture is seen: on the front alone, on the back as well, readable, or, of cloth, through and through. */
export type Sides = "front" | "both" | "through";

export interface Where {
    label: string;
    sheets: Sheet[];
    /** burns instead of the rectangle, where the first sheet is */
    mesh?: { quads: Quads; file: string };
    /** of the examples, printed on every sheet */
    picture: string | null;
    /** is it printed on the back as well? */
    back?: boolean;
    /** other settings than the letter's */
    sets: { material?: string; thickness?: number; pace?: number; wind?: number };
    change?: Material;
    contact?: boolean;
    /** tacks, which a click takes out */
    pins: Point[];
    /** what else holds the sheet, and where it goes, relative */
    hooks?: { points: Point[]; path: Key[] }[];
    /** the match that the page strikes */
    match: { at: Point; start: number; end: number } | null;
    /** a glowing ball that comes by */
    ember?: { radius: number; falloff: number; temperature: number; path: Key[] };
    /** a picture of when the front is where */
    arrival?: { picture: string; from: number; to: number };
    /** a ball that lies on the table */
    ball?: boolean;
    /** what hangs is lit from the front, and burns in the plane of x and z */
    upright: boolean;
    view: { at: Point; from: Point };
    /** where the keyboard begins */
    key: Point;
}

/** A4, m. */
export const SHEET = { width: 0.21, height: 0.297 };
export const BALL = { at: [0, 0, 0.055] as Point, radius: 0.055 };

const A4: [number, number] = [SHEET.width, SHEET.height], UP: Point = [90, 0, 0], FLAT: Point = [0, 0, 0];
const HUNG = 0.19; // m, height of the middle of a sheet that hangs
const HANGING = { upright: true, view: { at: [0, 0, 0.2], from: [0.17, -0.88, 0.31] }, key: [0, -0.002, 0.1] } satisfies Partial<Where>;
const UNEVEN: Material = { mass_loss: { from: 0.15, to: 0.6, noise: { scale: 0.02, octaves: 4, seed: 7 } } };
const AT_ONCE = { start: 0, end: 1.25 };

const one = (size: [number, number], rotate: Point, translate: Point, fine = 1): Sheet[] => [{ size, fine, rotate, translate }];

/** Quads of a torus about z, as scripts/make_torus.py makes them; both halves of the ring have the same uv. */
function torus(around: number, across: number): Quads {
    const RING = 0.1, TUBE = 0.042, positions: number[] = [], cells: number[] = [], uv: number[] = [], corner_uv: number[] = [], half = around / 2;
    for (let j = 0; j < across; j++)
        for (let i = 0; i < around; i++) {
            const turn = (2 * Math.PI * i) / around, roll = Math.PI + (2 * Math.PI * j) / across, away = RING + TUBE * Math.cos(roll);
            positions.push(away * Math.cos(turn), away * Math.sin(turn), TUBE * Math.sin(roll));
            uv.push(j / across, (i % half) / half);
            for (const [x, y] of [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]] as const) {
                cells.push((y % across) * around + (x % around));
                corner_uv.push(y / across, (x - i + (i % half)) / half);
            }
        }
    return { positions, cells, uv, corner_uv };
}

/** Eleven hooks that draw a curtain of this width together into pleats. */
function pleats(width: number, top: number): NonNullable<Where["hooks"]> {
    return Array.from({ length: 11 }, (_, i) => {
        const x = width * (i / 10 - 0.5) * 0.98;
        return {
            points: [[x, 0, top]] as Point[],
            path: [{ time: 0, position: [0, 0, 0] }, { time: 1, position: [-0.3 * x, (i % 2 ? 1 : -1) * 0.028 * width, 0] }] as Key[],
        };
    });
}

export const PLACES = {
    table: {
        label: "A letter on the table", sheets: one(A4, FLAT, [0, 0, 0.0005]), picture: "letter.png", sets: {}, pins: [],
        match: { at: [0.03, -0.045, 0], ...AT_ONCE }, upright: false, view: { at: [0, -0.012, 0.022], from: [0.085, -0.47, 0.178] }, key: [0, -0.02, 0.002],
    },
    blank: {
        label: "A blank sheet, to write on", sheets: one(A4, FLAT, [0, 0, 0.0005]), picture: null, sets: {}, pins: [], match: null, upright: false,
        view: { at: [0, -0.03, 0], from: [0.03, -0.36, 0.4] }, key: [0, -0.02, 0.002],
    },
    hung: {
        label: "A letter, hung up", sheets: one(A4, UP, [0, 0, HUNG]), picture: "letter.png", sets: {}, pins: [-0.1, 0, 0.1].map((x) => [x, 0, HUNG + 0.148]),
        match: { at: [0.02, 0, HUNG - 0.148], ...AT_ONCE }, ...HANGING,
    },
    ball: {
        label: "A letter over a ball", sheets: one(A4, FLAT, [0.004, 0.006, 0.118]), picture: "letter.png", sets: {}, pins: [], ball: true,
        match: { at: [0.05, -0.03, 0.118], ...AT_ONCE }, upright: false, view: { at: [0, -0.01, 0.05], from: [0.11, -0.5, 0.26] }, key: [0, -0.02, 0.118],
    },
    corners: {
        label: "A sheet held at its corners", sheets: one([0.21, 0.21], FLAT, [0, 0, 0.12]), picture: null, sets: { pace: 4 },
        pins: [], hooks: [-1, 1].flatMap((x) => [-1, 1].map((y) => ({ // they come nearer, or the sheet would tear by its weight
            points: [[0.103 * x, 0.103 * y, 0.12] as Point], path: [{ time: 0, position: [0, 0, 0] }, { time: 0.3, position: [-0.006 * x, -0.006 * y, 0] }],
        }))),
        match: { at: [0.02, -0.01, 0.115], ...AT_ONCE }, upright: false, view: { at: [0, -0.005, 0.07], from: [0.13, -0.6, 0.29] }, key: [0, -0.02, 0.12],
    },
    strip: {
        label: "A strip, lit below", sheets: one([0.06, 0.297], UP, [0, 0, HUNG], 1.6), picture: null, sets: { pace: 1.5 },
        pins: [-0.025, 0.025].map((x) => [x, 0, HUNG + 0.146]), match: { at: [0, 0, HUNG - 0.148], ...AT_ONCE }, ...HANGING,
    },
    stack: {
        label: "A stack of letters", picture: "letter.png", sets: { thickness: 0.0025, pace: 5 }, pins: [], contact: true,
        sheets: ([[0, 0, 0], [-19, 4, 7], [-13, 26, -5], [-41, 24, 9], [-36, 47, -3]] as const).map(([x, y, turn], i) => ({
            size: [0.105, 0.148], fine: 0.8, rotate: [0, 0, turn], translate: [0.018 + x / 1000, y / 1000 - 0.02, 0.002 + 0.0035 * i],
        })),
        match: { at: [0.066, -0.09, 0], ...AT_ONCE }, upright: false, view: { at: [0, -0.005, 0.025], from: [0.13, -0.33, 0.17] }, key: [0, -0.02, 0.018],
    },
    curtain: {
        label: "A curtain in a draught", sheets: one([0.3, 0.4], UP, [0, 0, 0.21], 0.75), picture: "curtain.jpg", sets: { material: "cotton", wind: 0.3 },
        change: { damping: 3, mass_loss: { from: 0.01, to: 0.3, noise: { scale: 0.025, octaves: 5, seed: 7 } } },
        pins: [], hooks: pleats(0.3, 0.408), match: { at: [0.02, 0, 0.015], start: 1, end: 2.5 }, ...HANGING,
        view: { at: [0, 0, 0.19], from: [0.22, -1.08, 0.3] },
    },
    title: {
        label: "A word burns itself in", sheets: one([0.22, 0.1], FLAT, [0, 0, 0.0005], 2.3), picture: null, sets: { pace: 1 },
        change: { mass_loss: { from: 0.25, to: 0.6, noise: { scale: 0.01, octaves: 4, seed: 7 } } }, pins: [], match: null,
        arrival: { picture: "title.png", from: 0.3, to: 4.3 }, upright: false, view: { at: [0, 0.005, 0.012], from: [0.04, -0.27, 0.19] }, key: [0, -0.02, 0.002],
    },
    ember: {
        label: "A glowing ball (figure 4)", sheets: one(A4, UP, [0, 0, HUNG]), picture: "letter.png", sets: { thickness: 0.002, pace: 2 },
        change: { damping: 1, ...UNEVEN }, pins: [-0.1, 0.1].map((x) => [x, 0, HUNG + 0.146]), match: null,
        ember: { radius: 0.025, falloff: 0.01, temperature: 1300, path: [{ time: 0, position: [-0.16, 0, 0.18] }, { time: 4, position: [0.16, 0, 0.18] }] }, ...HANGING,
    },
    torus: {
        label: "A torus (figure 11)", mesh: { quads: torus(64, 28), file: "scripts/make_torus.py --around 64 --across 28 torus.obj" },
        sheets: one([0.284, 0.284], [9, -5, 20], [0, 0, 0.075]), picture: "newspaper.jpg", back: true, sets: { thickness: 0.002, pace: 4.5 },
        change: { damping: 2, ...UNEVEN }, contact: true, pins: [], match: { at: [0.1, -0.11, 0.03], start: 0.2, end: 1.6 },
        upright: false, view: { at: [0, -0.005, 0.026], from: [0.14, -0.5, 0.25] }, key: [0.1, 0, 0.1],
    },
} satisfies Record<string, Where>;

export type Place = keyof typeof PLACES;

/** The row of a scene, as any row. */
export const placeOf = (place: Place): Where => PLACES[place];
