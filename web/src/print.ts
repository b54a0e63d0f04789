// What is printed on the sheet, and what is written over it: a picture over uv, its top row at v = 1.

const INK = "#1b2140", NIB = 0.0018; // m
const LONG = { least: 1400, most: 4096 }; // px of the longer side
const JUMP = 0.02; // m: further apart, two places are not joined

interface Place { u: number; v: number; width: number }

export class Print {
    readonly canvas = document.createElement("canvas");
    picture: HTMLImageElement | ImageBitmap | null = null;
    private size: [number, number] = [1, 1];
    private lines: Place[][] = [];

    /** A sheet of this size, m, with this picture, and without writing. */
    set(picture: HTMLImageElement | ImageBitmap | null, size: [number, number]): void {
        this.picture = picture;
        this.size = size;
        this.lines = [];
        const side = Math.min(Math.max(LONG.least, picture?.width ?? 0, picture?.height ?? 0), LONG.most), longest = Math.max(...size);
        [this.canvas.width, this.canvas.height] = size.map((x) => Math.max(1, Math.round((side * x) / longest))) as [number, number];
        this.redraw();
    }

    get count(): number { return this.lines.length; }

    /** The pen comes down. */
    begin(): void { this.lines.push([]); }

    /** The pen goes on to here. */
    to(u: number, v: number, pressure: number): void {
        const line = this.lines[this.lines.length - 1]!, last = line[line.length - 1], next = { u, v, width: NIB * (0.5 + pressure) };
        line.push(next);
        this.draw(last ?? next, next);
    }

    /** Takes back all but the first lines. */
    keep(count: number): void {
        if (count >= this.lines.length) return;
        this.lines.length = count;
        this.redraw();
    }

    private redraw(): void {
        const context = this.canvas.getContext("2d")!, { width, height } = this.canvas;
        context.fillStyle = "white";
        context.fillRect(0, 0, width, height);
        if (this.picture) context.drawImage(this.picture, 0, 0, width, height);
        for (const line of this.lines) line.forEach((place, i) => this.draw(line[i - 1] ?? place, place));
    }

    private draw(from: Place, to: Place): void {
        const context = this.canvas.getContext("2d")!, { width, height } = this.canvas, [across, along] = this.size;
        if (Math.hypot((to.u - from.u) * across, (to.v - from.v) * along) > JUMP) from = to;
        context.strokeStyle = INK;
        context.lineCap = "round";
        context.lineWidth = (to.width * width) / across;
        context.beginPath();
        context.moveTo(from.u * width, (1 - from.v) * height);
        context.lineTo(to.u * width, (1 - to.v) * height);
        context.stroke();
    }
}
