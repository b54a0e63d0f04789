// The sheets of "how it works". In each of them one stage of the step runs alone, or is what one looks at.
import type { Handle, Simulation, SimulationOptions, Material, Singe, Surface, View } from "singe";
import { ramp, type Diagram, type Point, type Rgb } from "./diagram.js";

/** What a reader may change. A choice is one of `names`, by its index. */
export interface Control { label: string; least: number; most: number; step: number; value: number; text?: (x: number) => string; names?: readonly string[] }
export type Values = Record<string, number>;

/** One sheet under way; `hand` is the reader's torch, far away until the pointer is down. */
export interface Live { sim: Simulation; hand: Handle | null }

export interface Lesson {
    controls: Record<string, Control>;
    begin(singe: Singe, values: Values): Live;
    /** Draws it, and tells its numbers. */
    paint(diagram: Diagram, live: Live, values: Values): string;
    view: { turn: number; tilt: number; span: number; middle: Point };
    /** the pointer is a torch, and does not turn the view */
    torch?: boolean;
    /** s, after which it begins again by itself */
    lasts?: number;
}

export const TIME_STEP = 1 / 240;
const SIZE = 0.1; // m, of most sheets
const G = 9.81;
const FLAME = 1100; // K
export const FAR: Point = [0, 0, 50];

const HEAT: Rgb[] = [[40, 30, 44], [120, 33, 66], [203, 62, 42], [246, 150, 50], [255, 243, 190]];
const MASS: Rgb[] = [[58, 47, 41], [88, 62, 46], [168, 128, 86], [226, 208, 178], [244, 236, 220]]; // from char, with a third of its mass, to paper
const STRAIN: Rgb[] = [[70, 120, 200], [226, 216, 200], [240, 120, 50], [220, 30, 40]];
const PAPER: Rgb = [236, 226, 206];
export const COLOURS: Record<string, Rgb> = { blue: [96, 150, 255], green: [86, 200, 120], red: [236, 84, 70], yellow: [240, 200, 80] };

interface Wanted {
    sim?: SimulationOptions; material?: Material; size?: readonly [number, number]; cells: number; translate?: Point;
    flame?: { radius: number; falloff: number; end: number; at: Point };
    hand?: boolean; pins?: Point[]; more?: (sim: Simulation) => void;
}

/** A sheet without gravity, gas and contact, unless they are wanted. */
function lay(singe: Singe, { sim: options, material, size = [SIZE, SIZE], cells, translate = [0, 0, 0], flame, hand, pins, more }: Wanted): Live {
    const sim = singe.create({
        time_step: TIME_STEP, pace: 2, gravity: [0, 0, 0], gas: { enabled: false }, contact: { enabled: false }, ...options,
        solver: { substeps: 4, tearing: false, creases: false, ...options?.solver },
    });
    try {
        const sheet = sim.addSheet({ size, cells: [cells, Math.round((cells * size[1]) / size[0])] }, { base: "office-paper", ...material }, { translate });
        sim.commit();
        more?.(sim);
        if (pins) sim.addPin({ sheet, points: pins.flat(), radius: 0.0005 });
        if (flame) sim.addSource({ kind: "ball", position: flame.at, radius: flame.radius, falloff: flame.falloff, temperature: FLAME, end: flame.end });
        return { sim, hand: hand ? sim.addSource({ kind: "ball", path: [{ time: 0, position: FAR }], radius: 0.004, falloff: 0.006, temperature: FLAME }) : null };
    } catch (error) {
        sim.destroy();
        throw error;
    }
}

const NO_SHRINK = { shrink_front: 0, shrink_back: 0 };
const mean = (surface: Surface, field: "temperature" | "mass", t: number) =>
    [0, 1, 2].reduce((sum, k) => sum + surface[field][surface.triangles[3 * t + k]!]!, 0) / 3;
const vertex = (view: View, i: number): Point => [view.position[4 * i]!, view.position[4 * i + 1]!, view.position[4 * i + 2]!];
const percent = (x: number) => `${(100 * x).toFixed(x < 0.01 ? 2 : 1)} %`;
const massColour = (mass: number) => ramp(MASS, (mass - 0.3) / 0.7);
const paperColour = (surface: Surface) => (t: number) => massColour(mean(surface, "mass", t));

/** m, the lowest and the highest of what is drawn. */
export function heightsOf({ position }: Surface): [number, number] {
    let [low, high] = [Infinity, -Infinity];
    for (let i = 2; i < position.length; i += 3) [low, high] = [Math.min(low, position[i]!), Math.max(high, position[i]!)];
    return [low, high];
}

/** The springs of a grid by colour, as pairs of particles: sides, neighbouring centres, centre to corners, diagonals. */
function* springs(view: View, colour: string): Generator<[number, number]> {
    const across = Math.sqrt(view.cell_count * 1.25), columns = Math.round(across); // of 5 by 4 cells
    for (let c = 0; c < view.cell_count; c++) {
        const corners = [0, 1, 2, 3].map((k) => view.cells[4 * c + k]!), centre = view.particle_count - view.cell_count + c;
        if (colour === "blue") for (let k = 0; k < 4; k++) yield [corners[k]!, corners[(k + 1) % 4]!];
        if (colour === "red") for (const corner of corners) yield [centre, corner];
        if (colour === "yellow") yield* [[corners[0]!, corners[2]!], [corners[1]!, corners[3]!]] as [number, number][];
        if (colour === "green" && (c + 1) % columns) yield [centre, centre + 1];
        if (colour === "green" && c + columns < view.cell_count) yield [centre, centre + columns];
    }
}

/** Relative change of length of the sides of cells, largest first of a cell. */
function sideStrain(view: View, cell: number): number {
    let worst = 0;
    for (let k = 0; k < 4; k++) {
        const [i, j] = [view.cells[4 * cell + k]!, view.cells[4 * cell + ((k + 1) % 4)]!];
        const length = (of: Float32Array) => Math.hypot(of[4 * i]! - of[4 * j]!, of[4 * i + 1]! - of[4 * j + 1]!, of[4 * i + 2]! - of[4 * j + 2]!);
        const strain = length(view.position) / length(view.rest_position) - 1;
        if (Math.abs(strain) > Math.abs(worst)) worst = strain;
    }
    return worst;
}

const METHODS = ["strand", "paper", "mass-spring"] as const;
const yesNo = (label: string): Control => ({ label, least: 0, most: 1, step: 1, value: 1, names: ["hidden", "shown"] });
const times = (x: number) => `${x.toFixed(2)}×`;

export const LESSONS: Record<string, Lesson> = {
    shell: {
        view: { turn: 0.5, tilt: 0.5, span: 0.062, middle: [0, 0, -0.004] },
        controls: Object.fromEntries(["blue", "green", "red", "yellow"].map((colour) => [colour, yesNo(`${colour[0]!.toUpperCase()}${colour.slice(1)} springs`)])),
        lasts: 12,
        begin: (singe) => lay(singe, {
            size: [0.05, 0.04], cells: 5, material: { thickness: 0.005 }, sim: { gravity: [0, 0, -0.4 * G], solver: { substeps: 10 } },
            pins: [[-0.025, -0.02, 0], [-0.025, 0.02, 0], [0.025, 0.02, 0]],
        }),
        paint(diagram, { sim }, values) {
            const view = sim.view();
            let count = 0;
            for (const [colour, rgb] of Object.entries(COLOURS)) {
                if (!values[colour]) continue;
                const pairs = [...springs(view, colour)];
                count += colour === "blue" ? 2 * view.cell_count + 9 : pairs.length; // a side is shared by two cells
                diagram.lines(pairs.map(([i, j]) => [vertex(view, i), vertex(view, j), rgb] as const), colour === "blue" || colour === "green" ? 2.2 : 1.2);
            }
            const centres = view.particle_count - view.cell_count;
            diagram.dots(Array.from({ length: view.particle_count }, (_, i) => [vertex(view, i), i < centres ? COLOURS.blue! : COLOURS.green!] as const), 2.6);
            return `${count} of ${view.spring_count.reduce((a, b) => a + b)} springs`;
        },
    },
    heat: {
        view: { turn: 0, tilt: Math.PI / 2, span: 0.112, middle: [0, 0, 0] }, torch: true,
        controls: {
            diffusivity: { label: "Diffusivity", least: 0.25, most: 8, step: 0.25, value: 1, text: times },
            losses: { label: "Losses", least: 0, most: 3, step: 0.1, value: 1, text: times },
        },
        begin: (singe, v) => lay(singe, {
            cells: 36, hand: true, flame: { radius: 0.004, falloff: 0.006, at: [0.01, 0, 0], end: Infinity },
            material: { mass_rate: 0, char_rate: 0, diffusivity: 3.4e-6 * v.diffusivity!, convection: 14 * v.losses!, emissivity: Math.min(1, 0.9 * v.losses!), ...NO_SHRINK },
        }),
        paint(diagram, { sim }) {
            const surface = sim.draw();
            diagram.surface(surface.position, 3, surface.triangles, (t) => ramp(HEAT, (mean(surface, "temperature", t) - 293) / 700));
            return `hottest ${Math.round(sim.stats().temperature_max - 273.15)} °C`;
        },
    },
    combustion: {
        view: { turn: 0, tilt: Math.PI / 2, span: 0.112, middle: [0, 0, 0] }, torch: true, lasts: 24,
        controls: {
            rate: { label: "Rate μ", least: 0.25, most: 2, step: 0.05, value: 1, text: times },
            eta: { label: "Heat η of the mass lost", least: 0.4, most: 1.4, step: 0.05, value: 1, text: times },
        },
        begin: (singe, v) => lay(singe, {
            cells: 36, hand: true, flame: { radius: 0.006, falloff: 0.006, at: [-0.035, -0.035, 0], end: 1 },
            material: { mass_rate: 9e-3 * v.rate!, heat_share: 0.25 * v.eta!, mass_loss: 0, ablate: false, ...NO_SHRINK },
        }),
        paint(diagram, { sim }) {
            const surface = sim.draw();
            diagram.surface(surface.position, 3, surface.triangles, (t) => {
                const heat = (mean(surface, "temperature", t) - 600) / 700, mass = massColour(mean(surface, "mass", t));
                return heat > 0 ? ramp([mass, [246, 120, 40], [255, 220, 130]], heat) : mass;
            });
            const stats = sim.stats();
            return `${percent(stats.burnt_fraction)} burnt, hottest ${Math.round(stats.temperature_max - 273.15)} °C`;
        },
    },
    shrinking: {
        view: { turn: 0.45, tilt: 0.62, span: 0.118, middle: [0, 0, 0] }, lasts: 20,
        controls: {
            amount: { label: "Shrinking", least: 0, most: 1, step: 0.05, value: 0.5, text: percent },
            bias: { label: "More in the upper layer", least: -0.3, most: 0.3, step: 0.02, value: 0.12, text: percent },
        },
        begin: (singe, v) => lay(singe, {
            cells: 30, sim: { solver: { substeps: 8 } }, flame: { radius: 0.012, falloff: 0.006, at: [0, 0, 0], end: 1.2 }, pins: corners(SIZE / 2),
            material: {
                ablate: false, mass_loss: 0, fibre_shrink: 1, shrink_front: Math.max(0, v.amount! + v.bias! / 2), shrink_back: Math.max(0, v.amount! - v.bias! / 2),
            },
        }),
        paint(diagram, { sim }) {
            const surface = sim.draw();
            diagram.surface(surface.position, 3, surface.triangles, paperColour(surface));
            const [low, high] = heightsOf(surface);
            return `heights from ${(1000 * low).toFixed(1)} to ${(1000 * high).toFixed(1)} mm`;
        },
    },
    ablation: {
        view: { turn: 0, tilt: Math.PI / 2, span: 0.112, middle: [0, 0, 0] }, torch: true, lasts: 24,
        controls: {
            level: { label: "Level", least: 0.2, most: 0.9, step: 0.05, value: 0.6, text: (x) => x.toFixed(2) },
            cells: { label: "Cells along a side", least: 6, most: 30, step: 2, value: 12 },
        },
        begin: (singe, v) => lay(singe, {
            cells: v.cells!, hand: true, flame: { radius: 0.01, falloff: 0.008, at: [0, 0, 0], end: 1.5 },
            material: { mass_loss: v.level!, ...NO_SHRINK },
        }),
        paint(diagram, { sim }, { level }) {
            const surface = sim.draw(), view = sim.view();
            diagram.surface(surface.position, 3, surface.triangles, paperColour(surface), 1);
            diagram.dots(Array.from({ length: view.particle_count }, (_, i): [Point, Rgb] =>
                [[view.rest_position[4 * i]!, view.rest_position[4 * i + 1]!, 0.001], view.mass[i]! > level! ? [70, 54, 44] : [236, 84, 70]]), 1.7);
            return `${surface.triangle_count} triangles`;
        },
    },
    projection: {
        view: { turn: 0.5, tilt: 0.2, span: 0.225, middle: [0.0, 0.02, -0.075] }, lasts: 10,
        controls: {
            method: { label: "Solver", least: 0, most: 2, step: 1, value: 0, names: ["strands (ours)", "the paper's", "springs by Hooke's law"] },
            projections: { label: "Projections a step", least: 1, most: 12, step: 1, value: 4 },
        },
        begin(singe, v) {
            const method = METHODS[v.method!]!, count = v.projections!;
            const solver = method === "strand" ? { method, substeps: count, projections: 1 }
                : method === "paper" ? { method, substeps: 1, projections: count } : { method, substeps: count, stiffness: 40 };
            return lay(singe, {
                size: [0.16, 0.16], cells: 22, sim: { gravity: [0, 0, -G], solver: solver as SimulationOptions["solver"] }, pins: [[-0.08, 0.08, 0], [0.08, 0.08, 0]],
                material: { thickness: 0.001, damping: 0.3 },
            });
        },
        paint(diagram, { sim }) {
            const surface = sim.draw(), view = sim.view(), perCell = surface.triangle_count / view.cell_count;
            const strains = Array.from({ length: view.cell_count }, (_, c) => sideStrain(view, c));
            diagram.surface(surface.position, 3, surface.triangles, (t) => ramp(STRAIN, 1 / 3 + (strains[Math.floor(t / perCell)] ?? 0) * 10));
            const sorted = strains.map(Math.abs).sort((a, b) => a - b);
            return `99 of 100 sides within ${percent(sorted[Math.floor(0.99 * sorted.length)]!)}`;
        },
    },
    contact: {
        view: { turn: 0.5, tilt: 0.5, span: 0.165, middle: [0, 0, 0.035] }, lasts: 9,
        controls: { friction: { label: "Friction", least: 0, most: 1, step: 0.05, value: 0.4, text: (x) => x.toFixed(2) } },
        begin: (singe, v) => lay(singe, {
            size: [0.14, 0.14], cells: 26, translate: [0.004, 0.006, 0.085], sim: { gravity: [0, 0, -G], contact: { enabled: true, friction: v.friction! }, solver: { substeps: 5 } },
            material: { base: "cotton", thickness: 0.001 },
            more: (sim) => {
                sim.addCollider({ kind: "sphere", position: BALL.at, radius: BALL.radius, friction: v.friction!, offset: 0.001 });
                sim.addCollider({ kind: "plane", friction: v.friction!, offset: 0.001 });
            },
        }),
        paint(diagram, { sim }) {
            const surface = sim.draw();
            diagram.surface(surface.position, 3, surface.triangles, () => PAPER, 0, BALL);
            let nearest = Infinity;
            for (let i = 0; i < surface.position.length; i += 3)
                nearest = Math.min(nearest, Math.hypot(...[0, 1, 2].map((c) => surface.position[i + c]! - BALL.at[c]!)) - BALL.radius);
            return `${(1000 * Math.max(nearest, -1)).toFixed(2)} mm from the ball at the nearest`;
        },
    },
};

const BALL = { at: [0, 0, 0.035] as const, radius: 0.035 };
function corners(half: number): Point[] { return [[-half, -half, 0], [half, -half, 0], [-half, half, 0], [half, half, 0]]; }
