// Sparks and flakes in the air, after program/preview/sparks.c, flakes.c and airborne.c: where embers glow, crumbs are
// thrown up, cool and go out, and small plates of char and ash are carried off and tumble down. All follows from a
// frame's mesh and its time, so that scrubbing shows the same. Used by the page (web/src) and by `singe view`.
import { LOOK } from "./look.js";
import { hash } from "./math.js";

/** Floats of one thing: from, to, across (m), size (m; 0: a plate at `from` with half axes `to` and `across`), temperature (K), strength of a spark or ash of a plate. */
export const AIRBORNE_FLOATS = 12;
export const AIRBORNE_LIMIT = 400;

const CROWD = 0.25, OPEN = 1 / 60; // OPEN: s of a spark's way that is seen
const SPARK = { cell: 0.012, slot: 0.05, life: 1.05, each: 4, rate: 420, lag: 0.09, cold: 900, cooling: 1.7 };
const FLAKE = { cell: 0.02, slot: 0.1, life: 1.7, each: 3, rate: 190, carried: 0.7, starting: 0.06, cold: 600 };

const step = (a, b, x) => { const t = Math.min(Math.max((x - a) / (b - a), 0), 1); return t * t * (3 - 2 * t); };
const activity = (rate) => Math.max(rate, 0) / (Math.max(rate, 0) + 0.12);
/** ember_leaf of program/formats/ember.h. */
const leaf = (glowing, starved, burn) => {
    const alone = activity(glowing);
    return alone + LOOK.STARVED * step(LOOK.STARVED_SLOW, LOOK.STARVED_FAST, starved) * step(LOOK.STARVED_BEGINS, LOOK.STARVED_FULL, burn) * (1 - alone);
};

const unit = (x) => hash(x) / 4294967296;

/** What is asked of a vertex: position and rest (m), temperature (K), burn rate and its glowing part (1/s), burnt share, its gradient (1/m), and the part of the rate of char that feeds a flame. */
export const POSITION = 0, REST = 3, TEMPERATURE = 6, RATE = 7, GLOWING = 8, BURN = 9, GRADIENT = 10, STARVED = 11;

/** Where embers glow: of each such triangle the length of its glowing line (m), its flaming part, its place, and that at rest. */
function embersOf(triangles, value) {
    const embers = [];
    for (let t = 0; t < triangles.length; t += 3) {
        const a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
        if (Math.max(value(a, TEMPERATURE), value(b, TEMPERATURE), value(c, TEMPERATURE)) < 800) continue;
        const burnA = value(a, BURN), burnB = value(b, BURN), burnC = value(c, BURN), low = Math.min(burnA, burnB, burnC, 1), high = Math.max(burnA, burnB, burnC, 0);
        if (high < 0.15) continue;
        const mean = (field) => (value(a, field) + value(b, field) + value(c, field)) / 3;
        const x = value(a, POSITION), y = value(a, POSITION + 1), z = value(a, POSITION + 2);
        const ax = value(b, POSITION) - x, ay = value(b, POSITION + 1) - y, az = value(b, POSITION + 2) - z;
        const bx = value(c, POSITION) - x, by = value(c, POSITION + 1) - y, bz = value(c, POSITION + 2) - z;
        const area = 0.5 * Math.sqrt((ay * bz - az * by) ** 2 + (az * bx - ax * bz) ** 2 + (ax * by - ay * bx) ** 2), rate = mean(RATE), glowing = mean(GLOWING);
        const line = low < LOOK.EMBER_BURN && high > LOOK.EMBER_BURN ? (area * Math.max(mean(GRADIENT), 20)) / Math.max(high - low, 0.02) : 0;
        const length = activity(rate) * Math.min(line, 2 * Math.sqrt(area)) + (leaf(glowing, mean(STARVED), (burnA + burnB + burnC) / 3) * area) / LOOK.LEAF_WIDTH;
        if (length > 0) embers.push({ length, flaming: rate > 0 ? length * (1 - glowing / rate) : 0, at: [mean(POSITION), mean(POSITION + 1), mean(POSITION + 2)], rest: [mean(REST), mean(REST + 1), mean(REST + 2)] });
    }
    return embers;
}

/** Embers gathered in cells of the sheet at rest. */
function sitesOf(embers, cell) {
    const sites = new Map();
    for (const { length, flaming, at, rest } of embers) {
        const key = rest.reduce((sum, x) => hash(sum ^ Math.floor(x / cell + 0.37)), 1), site = sites.get(key) ?? { key, length: 0, flaming: 0, x: 0, y: 0, z: 0 };
        site.length += length;
        site.flaming += flaming;
        site.x += length * at[0];
        site.y += length * at[1];
        site.z += length * at[2];
        sites.set(key, site);
    }
    return [...sites.values()].map((s) => ({ ...s, x: s.x / s.length, y: s.y / s.length, z: s.z / s.length }));
}

/** Calls `make` for each thing that a site has thrown within its life, with its random key, age (s), and how surely it is there. */
function thrown(sites, kind, wanted, salt, time, make) {
    const total = sites.reduce((sum, { length }) => sum + length, 0), rate = (wanted * kind.rate) / Math.sqrt(1 + total / CROWD);
    const last = Math.floor(time / kind.slot), first = Math.floor((time - kind.life) / kind.slot);
    for (const site of sites)
        for (let slot = first; slot <= last; slot++) {
            const moment = hash(site.key ^ Math.imul(slot, salt)), burst = kind === SPARK && unit(moment) < 0.012; // a rim that collapses throws many
            const chance = (rate * site.length * kind.slot * (burst ? 14 : 0.8)) / kind.each;
            for (let k = 0; k < kind.each; k++) {
                const key = hash(moment + 97 * k), strength = Math.min(5 * (1 - unit(key) / chance), 1);
                const age = time - (slot + unit(key ^ 0x5bd1e995)) * kind.slot;
                if (strength > 0 && age >= 0) make(site, key, age, strength, burst);
            }
        }
}

/** Where a spark is at its age: it leaves at the speed `launch`, and soon goes with the air. */
function sparkAt({ from, launch, air, wander, turn }, age, out, at) {
    const lag = SPARK.lag * (1 - Math.exp(-age / SPARK.lag)), aside = (wander * age * age) / (age + 0.15);
    for (let c = 0; c < 3; c++) out[at + c] = from[c] + air[c] * (age - lag) + launch[c] * lag;
    out[at] += aside * (Math.sin(turn[0] + 7.3 * age) - Math.sin(turn[0]));
    out[at + 1] += aside * (Math.sin(turn[1] + 6.1 * age) - Math.sin(turn[1]));
}

/**
 * What flies at the time (s): AIRBORNE_FLOATS for each thing.
 * @param {Uint32Array} triangles @param {(vertex: number, field: number) => number} value @param {number} time
 * @param wanted how many, as `preview: sparks` and `flakes` of a scene
 */
export function airborneOf(triangles, value, time, wanted = { sparks: 1, flakes: 1 }) {
    const out = new Float32Array(AIRBORNE_FLOATS * AIRBORNE_LIMIT), now = time % 4096;
    let count = 0;

    const embers = embersOf(triangles, value), sparks = sitesOf(embers, SPARK.cell), length = sparks.reduce((sum, s) => sum + s.length, 0);
    const flaming = sparks.reduce((sum, s) => sum + s.flaming, 0) / Math.max(length, 1e-9), updraft = 0.4 + 0.85 * flaming;
    thrown(sparks, SPARK, wanted.sparks, 0x8da6b343, now, (site, key, age, strength, burst) => {
        const life = SPARK.life * (0.3 + 0.7 * unit(key + 4));
        if (age >= life || count === AIRBORNE_LIMIT) return;
        const r = Array.from({ length: 10 }, (_, n) => unit(key + 1 + n));
        const turn = 2 * Math.PI * r[0], up = 0.15 + 0.85 * r[1], aside = Math.sqrt(1 - up * up), speed = (burst ? 0.5 : 0.15) + 0.9 * r[2] * r[2];
        const spark = {
            from: [site.x + 0.006 * (r[6] - 0.5), site.y + 0.006 * (r[7] - 0.5), site.z],
            launch: [speed * aside * Math.cos(turn), speed * aside * Math.sin(turn), speed * up],
            air: [0.28 * (r[8] - 0.5), 0.28 * (r[9] - 0.5), updraft * (0.55 + 0.7 * r[9]) - 0.5 * r[5]],
            wander: 0.02 + 0.1 * r[6], turn: [2 * Math.PI * r[7], 2 * Math.PI * r[8]],
        };
        const place = AIRBORNE_FLOATS * count++;
        sparkAt(spark, Math.max(age - 0.5 * OPEN, 0), out, place);
        sparkAt(spark, age + 0.5 * OPEN, out, place + 3);
        out[place + 9] = 0.0003 + 0.0006 * r[5] ** 3;
        out[place + 10] = SPARK.cold + (420 * r[4] + 1500 - SPARK.cold) * Math.exp((-SPARK.cooling * age) / life);
        out[place + 11] = strength * (1 - step(0.6, 1, age / life));
    });

    thrown(sitesOf(embers, FLAKE.cell), FLAKE, wanted.flakes, 0xd8163841, now, (site, key, age) => {
        const life = FLAKE.life * (0.5 + 0.5 * unit(key + 13));
        if (age >= life || count === AIRBORNE_LIMIT) return;
        const r = Array.from({ length: 14 }, (_, n) => unit(key + 1 + n));
        const ash = r[0], fall = Math.sqrt((2 * 9.81 * (0.02 - 0.014 * ash)) / (1.2 * 1.3)), share = age / life;
        const size = (0.0011 + 0.0032 * r[1] ** 3) * (1 - step(0.85, 1, share)), often = Math.min(Math.max((0.44 * fall) / size, 14), 50);
        const rise = (0.8 + 0.4 * (site.flaming / site.length)) * Math.min(Math.max(1.3 * r[7] - 0.25, 0), 1);
        const late = age - FLAKE.starting * (1 - Math.exp(-age / FLAKE.starting));
        const height = site.z + rise * FLAKE.carried * (1 - Math.exp(-age / FLAKE.carried)) - fall * late;
        const turn = 2 * Math.PI * r[10] + 5 * (r[11] - 0.5) * age, beat = often * age + 2 * Math.PI * r[9];
        const tilt = r[8] < 0.4 ? beat : (0.5 + 1.1 * r[8]) * Math.sin(beat), glide = 0.7 * fall * (r[8] < 0.4 ? late : (Math.cos(2 * Math.PI * r[9]) - Math.cos(beat)) / often);
        const [c, s] = [Math.cos(turn), Math.sin(turn)], [ct, st] = [Math.cos(tilt), Math.sin(tilt)], narrow = size * (0.45 + 0.5 * r[4]);
        const x = site.x + 0.01 * (r[2] - 0.5) + 0.24 * (r[5] - 0.5) * late - s * glide, y = site.y + 0.01 * (r[3] - 0.5) + 0.24 * (r[6] - 0.5) * late + c * glide;
        out.set([x, y, height, size * c, size * s, 0, -narrow * ct * s, narrow * ct * c, -narrow * st, 0,
            FLAKE.cold + (840 + 300 * r[13] - FLAKE.cold) * Math.exp(-3.2 * share), ash], AIRBORNE_FLOATS * count++);
    });
    return out.subarray(0, AIRBORNE_FLOATS * count);
}
