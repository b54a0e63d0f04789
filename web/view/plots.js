// The tables of a run, and lines over its frames.

/** Rows of a CSV that singe wrote: numbers where they are numbers. */
export function readTable(text) {
    const lines = text.trimEnd().split("\n"), names = (lines.shift() ?? "").split(",");
    return lines.map((line) => Object.fromEntries(line.split(",").map((cell, i) => [names[i], cell === "" || Number.isNaN(+cell) ? cell : +cell])));
}

const percent = (x) => `${(100 * x).toFixed(x < 0.0995 ? 1 : 0)} %`, celsius = (k) => `${Math.round(k - 273.15)} °C`;
const mass = (x) => (x < 1e-3 ? `${(1e6 * x).toFixed(0)} mg` : `${(1e3 * x).toFixed(2)} g`), joule = (x) => (Math.abs(x) < 1000 ? `${x.toFixed(0)} J` : `${(x / 1000).toFixed(1)} kJ`);
const ms = (x) => (x < 1000 ? `${x.toFixed(0)} ms` : `${(x / 1000).toFixed(1)} s`), whole = (x) => `${x}`;

/** Lines of one plot that share a scale say so by the same `axis`. */
export const PLOTS = {
    Fire: [["burnt_fraction", "burnt", "#f59a3d", percent], ["temperature_max", "hottest", "#e2533f", celsius], ["front_speed", "front", "#d9c7a4", (x) => `${(1e3 * x).toFixed(1)} mm/s`]],
    Mass: [["mass", "mass", "#d9c7a4", mass], ["pieces", "pieces", "#7fb3d5", whole], ["tears", "tears", "#c58bd0", whole]],
    Heat: [["heat_of_combustion", "combustion", "#f59a3d", joule, "J"], ["heat_in", "from sources", "#e2533f", joule, "J"], ["heat_lost", "lost", "#7fb3d5", joule, "J"], ["heat_stored", "stored", "#d9c7a4", joule, "J"]],
    Strain: [["strain_mean", "mean", "#9cc28a", percent, "s"], ["strain_p99", "of 99 %", "#d9c7a4", percent, "s"], ["strain_max", "max", "#e2533f", percent]],
    Cost: [["ms_dynamics", "dynamics", "#7fb3d5", ms, "t"], ["ms_ablate", "ablation", "#c58bd0", ms, "t"], ["ms_gas", "gas", "#9cc28a", ms, "t"], ["ms_heat", "heat", "#e2533f", ms, "t"], ["ms_output", "output", "#d9c7a4", ms, "t"]],
};
export const EVENT_COLOURS = { ignition: "#f59a3d", hole: "#e2533f", piece: "#7fb3d5" };

function prepare(canvas) {
    const scale = Math.min(devicePixelRatio || 1, 2), w = canvas.clientWidth, h = canvas.clientHeight;
    if (canvas.width !== Math.round(w * scale) || canvas.height !== Math.round(h * scale)) {
        canvas.width = Math.round(w * scale);
        canvas.height = Math.round(h * scale);
    }
    const c = canvas.getContext("2d");
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, w, h);
    return { c, w, h };
}

/** Lines over [first, last]; `inset` is the slider's half thumb, so that both agree. */
export function drawLines(canvas, lines, { first, last, now, inset = 0, ticks = [], done = last }) {
    const { c, w, h } = prepare(canvas), x = (frame) => inset + ((w - 2 * inset) * (frame - first)) / Math.max(last - first, 1);
    c.strokeStyle = "rgb(242 232 216 / .10)";
    c.lineWidth = 1;
    for (const y of [0.5, h - 0.5]) { c.beginPath(); c.moveTo(inset, y); c.lineTo(w - inset, y); c.stroke(); }
    if (done < last) {
        c.fillStyle = "rgb(242 232 216 / .045)";
        c.fillRect(x(done), 0, w - inset - x(done), h);
    }
    for (const { frame, colour } of ticks) {
        c.fillStyle = colour;
        c.fillRect(x(frame) - 0.5, h - 7, 1.5, 7);
    }
    const ends = new Map();
    for (const { axis, points } of lines)
        for (const [, y] of points) {
            const [low, high] = ends.get(axis) ?? [Math.min(0, y), -Infinity];
            ends.set(axis, [Math.min(low, y), Math.max(high, y)]);
        }
    for (const { axis, points, colour, tight } of lines) {
        let [low, high] = ends.get(axis) ?? [0, 1];
        if (tight) low = Math.min(...points.map(([, y]) => y));
        if (!(high > low)) high = low + 1;
        const y = (v) => h - 5 - ((h - 10) * (v - low)) / (high - low);
        c.strokeStyle = colour;
        c.lineWidth = 1.6;
        c.lineJoin = "round";
        c.beginPath();
        points.forEach(([frame, v], i) => (i ? c.lineTo(x(frame), y(v)) : c.moveTo(x(frame), y(v))));
        c.stroke();
        const here = points.reduce((best, p) => (p[0] <= now && (!best || p[0] > best[0]) ? p : best), null);
        if (here) { c.fillStyle = colour; c.beginPath(); c.arc(x(now), y(here[1]), 3, 0, 7); c.fill(); }
    }
    c.fillStyle = "rgb(255 255 255 / .55)";
    c.fillRect(x(now) - 0.5, 0, 1, h);
}
