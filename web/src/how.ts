// "How it works": each equation beside a live sheet. A sheet runs while it is in sight.
import { load, type Singe } from "singe";
import { Diagram } from "./diagram.js";
import { FAR, heightsOf, LESSONS, TIME_STEP, type Lesson, type Live, type Values } from "./lessons.js";

const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
const BUDGET = 14; // ms of computing in a frame
const TURN = 0.008; // radians a pixel

class Figure {
    private diagram: Diagram;
    private live: Live | null = null;
    private values: Values;
    private turn: number;
    private tilt: number;
    private said: HTMLElement;
    private playing = !still;
    private pointer: { id: number; x: number; y: number } | null = null;
    private costOfStep = 1;
    private play: HTMLButtonElement;
    inSight = false;

    constructor(readonly name: string, private lesson: Lesson, figure: HTMLElement, private singe: Singe) {
        const canvas = document.createElement("canvas"), panel = document.createElement("figcaption");
        canvas.setAttribute("role", "img");
        canvas.setAttribute("aria-label", figure.dataset.label ?? name);
        this.diagram = new Diagram(canvas);
        this.said = Object.assign(document.createElement("output"), { className: "said" });
        this.values = Object.fromEntries(Object.entries(lesson.controls).map(([key, { value }]) => [key, value]));
        this.turn = lesson.view.turn;
        this.tilt = lesson.view.tilt;
        this.play = button("Pause", () => this.setPlaying(!this.playing));
        const row = Object.assign(document.createElement("div"), { className: "row" });
        row.append(this.play, button("Again", () => this.begin()), this.said);
        panel.append(...Object.keys(lesson.controls).map((key) => this.control(key)), row);
        figure.append(canvas, panel);
        this.setPlaying(this.playing);
        this.listen(canvas);
        this.begin();
    }

    private control(key: string): HTMLElement {
        const { label, least, most, step, names, text = String } = this.lesson.controls[key]!, box = document.createElement("label");
        const change = (value: number) => {
            this.values[key] = value;
            this.begin();
        };
        if (names && names.length === 2) {
            const input = Object.assign(document.createElement("input"), { type: "checkbox", checked: !!this.values[key] });
            input.onchange = () => { // shows and hides: nothing begins again
                this.values[key] = Number(input.checked);
                this.paint();
            };
            box.className = "check";
            box.append(input, label);
        } else if (names) {
            const select = document.createElement("select");
            select.append(...names.map((name, i) => Object.assign(document.createElement("option"), { value: String(i), textContent: name })));
            select.onchange = () => change(Number(select.value));
            box.append(label, select);
        } else {
            const input = Object.assign(document.createElement("input"), { type: "range", min: String(least), max: String(most), step: String(step) });
            const output = document.createElement("output");
            input.value = String(this.values[key]);
            output.textContent = text(this.values[key]!);
            input.oninput = () => {
                output.textContent = text(Number(input.value));
                change(Number(input.value));
            };
            box.append(label, output, input);
        }
        return box;
    }

    private setPlaying(playing: boolean): void {
        this.playing = playing;
        this.play.textContent = playing ? "Pause" : "Play";
    }

    private listen(canvas: HTMLCanvasElement): void {
        canvas.addEventListener("pointerdown", (event) => {
            this.pointer = { id: event.pointerId, x: event.offsetX, y: event.offsetY };
            canvas.setPointerCapture(event.pointerId);
            this.torch();
        });
        canvas.addEventListener("pointermove", (event) => {
            if (this.pointer?.id !== event.pointerId) return;
            if (!this.lesson.torch) {
                this.turn -= TURN * (event.offsetX - this.pointer.x);
                this.tilt = Math.min(Math.max(this.tilt + TURN * (event.offsetY - this.pointer.y), 0.02), Math.PI / 2);
                this.paint();
            }
            this.pointer = { id: event.pointerId, x: event.offsetX, y: event.offsetY };
            this.torch();
        });
        for (const name of ["pointerup", "pointercancel"] as const) canvas.addEventListener(name, () => {
            this.pointer = null;
            this.torch();
        });
        canvas.classList.toggle("torch", !!this.lesson.torch);
    }

    /** The reader's torch goes to the pointer, or away. */
    private torch(): void {
        if (!this.live?.hand) return;
        const at = this.pointer ? this.diagram.ground(this.pointer.x, this.pointer.y) : FAR;
        this.live.sim.moveSource(this.live.hand, [{ time: 0, position: at }]);
        if (this.pointer) this.setPlaying(true);
    }

    begin(): void {
        try {
            const fresh = this.lesson.begin(this.singe, this.values);
            this.live?.sim.destroy();
            this.live = fresh;
            this.paint();
        } catch (error) {
            this.said.textContent = error instanceof Error ? error.message : String(error);
        }
    }

    paint(): void {
        if (!this.live) return;
        const { span, middle } = this.lesson.view;
        this.diagram.begin(this.turn, this.tilt, span, middle);
        this.said.textContent = this.lesson.paint(this.diagram, this.live, this.values);
    }

    /** Goes on by some seconds, or by less where the machine is slow. */
    advance(seconds: number, most: number): void {
        if (!this.live) return;
        const begun = performance.now();
        try {
            const steps = this.live.sim.advance(seconds, most);
            if (steps) this.costOfStep += 0.2 * ((performance.now() - begun) / steps - this.costOfStep);
        } catch (error) { // such as springs that explode
            this.setPlaying(false);
            this.said.textContent = error instanceof Error ? error.message : String(error);
            return;
        }
        if (this.lesson.lasts && this.live.sim.view().time > this.lesson.lasts) this.begin();
        else this.paint();
    }

    tick(passed: number): void {
        if (!this.inSight || !this.playing) return;
        this.advance(Math.max(TIME_STEP, Math.min(passed, 0.04)), Math.max(1, Math.floor(BUDGET / this.costOfStep)));
    }

    get stats() { return this.live!.sim.stats(); }
    get heights() { return heightsOf(this.live!.sim.draw()); }
    get text() { return this.said.textContent; }
    set(key: string, value: number): void {
        this.values[key] = value;
        this.begin();
    }
}

function button(text: string, click: () => void): HTMLButtonElement {
    const made = Object.assign(document.createElement("button"), { type: "button", textContent: text });
    made.onclick = click;
    return made;
}

async function start(): Promise<void> {
    const singe = await load(new URL("./singe.wasm", import.meta.url)), figures = new Map<string, Figure>();
    for (const element of document.querySelectorAll<HTMLElement>("figure[data-lesson]")) {
        const name = element.dataset.lesson!;
        figures.set(name, new Figure(name, LESSONS[name]!, element, singe));
    }
    const seen = new IntersectionObserver((entries) => {
        for (const { target, isIntersecting } of entries) figures.get((target as HTMLElement).dataset.lesson!)!.inSight = isIntersecting;
    }, { threshold: 0.25 });
    for (const element of document.querySelectorAll("figure[data-lesson]")) seen.observe(element);
    addEventListener("resize", () => figures.forEach((figure) => figure.paint()));
    let last = performance.now();
    const tick = (now: number) => {
        requestAnimationFrame(tick);
        const passed = (now - last) / 1000;
        last = now;
        if (!document.hidden) figures.forEach((figure) => figure.tick(passed));
    };
    requestAnimationFrame(tick);
    Object.assign(globalThis, { figures }); // for tests
}

start().catch((error) => {
    document.querySelector("#trouble")!.textContent = `The sheets could not be loaded: ${error instanceof Error ? error.message : error}. A browser of 2023 or later has WebAssembly with simd128.`;
});
