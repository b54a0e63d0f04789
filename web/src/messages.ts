// Between the page and its worker.
import type { FileQuads, Surface } from "singe";
import type { Fire, Lights } from "./fire.js";
import type { Point } from "./places.js";
import type { Settings, Stroke } from "./scene.js";

export type Shape = FileQuads;

/** How often undo goes back. */
export const MARKS = 6;

export type ToWorker =
    | { kind: "load"; wasm: string }
    | { kind: "begin"; settings: Settings; shape: Shape | null; strokes: Stroke[]; pins: Point[] }
    | { kind: "advance"; seconds: number; most: number; match: Point | null; breath: { at: Point; direction: Point } | null; hand: Point | null }
    | { kind: "set"; settings: Settings }
    | { kind: "grab"; rest: Point; at: Point } | { kind: "release" }
    | { kind: "pin"; rest: Point } | { kind: "unpin"; index: number }
    | { kind: "mark" } | { kind: "undo" } | { kind: "surface" };

export interface Frame {
    kind: "frame";
    vertices: Float32Array; triangles: Uint32Array; burning: number;
    fire: Fire | null; lights: Lights; airborne: Float32Array;
    time: number; steps: number; ms: number; burnt: number; pieces: number; tears: number; springs: number; hottest: number;
    pins: Point[]; match: Point | null; marks: number; memory: number; skipped: boolean; strokes: Stroke[]; pinRests: Point[];
}

export type FromWorker =
    | { kind: "loaded"; version: string } | Frame | { kind: "failed"; message: string } | { kind: "begun"; springs: number }
    | { kind: "surface"; surface: Surface };
