// A diagram of a sheet on a canvas: parallel projection, triangles painted from the far ones to the near ones.
export type Rgb = readonly [number, number, number];
export type Point = readonly [number, number, number];

/** A colour between those of a ramp, which are equally far apart; x from 0 to 1. */
export function ramp(colours: readonly Rgb[], x: number): Rgb {
    const at = Math.min(Math.max(x, 0), 1) * (colours.length - 1), i = Math.min(Math.floor(at), colours.length - 2), share = at - i;
    const mix = (c: 0 | 1 | 2) => colours[i]![c] * (1 - share) + colours[i + 1]![c] * share;
    return [mix(0), mix(1), mix(2)];
}

const css = ([r, g, b]: Rgb, shade: number) => `rgb(${Math.round(r * shade)} ${Math.round(g * shade)} ${Math.round(b * shade)})`;

export class Diagram {
    private pen: CanvasRenderingContext2D;
    private right: Point = [1, 0, 0];
    private up: Point = [0, 1, 0];
    private toEye: Point = [0, 0, 1];
    private scale = 1;
    private middle: Point = [0, 0, 0];

    constructor(readonly canvas: HTMLCanvasElement) { this.pen = canvas.getContext("2d")!; }

    /** Clears it. `turn` and `tilt` in radians: a tilt of 0 looks along the ground, one of pi/2 from above; `span` in m
     * is what fits into the canvas. */
    begin(turn: number, tilt: number, span: number, middle: Point): void {
        const { canvas } = this, pixels = Math.min(devicePixelRatio, 2);
        const width = Math.round(canvas.clientWidth * pixels), height = Math.round(canvas.clientHeight * pixels);
        if (canvas.width !== width || canvas.height !== height) {
            canvas.width = width;
            canvas.height = height;
        }
        const [s, c, high, low] = [Math.sin(turn), Math.cos(turn), Math.sin(tilt), Math.cos(tilt)];
        this.right = [c, s, 0];
        this.up = [-s * high, c * high, low];
        this.toEye = [s * low, -c * low, high];
        this.scale = Math.min(width, height) / span;
        this.middle = middle;
        this.pen.clearRect(0, 0, width, height);
        this.pen.lineJoin = this.pen.lineCap = "round";
    }

    private flat(x: number, y: number, z: number): [number, number] {
        const p = [x - this.middle[0], y - this.middle[1], z - this.middle[2]], { right, up, canvas } = this;
        const across = p[0]! * right[0] + p[1]! * right[1] + p[2]! * right[2], along = p[0]! * up[0] + p[1]! * up[1] + p[2]! * up[2];
        return [canvas.width / 2 + this.scale * across, canvas.height / 2 - this.scale * along];
    }

    /** Where a place of the canvas, in CSS pixels, meets the plane z = 0. */
    ground(x: number, y: number): Point {
        const pixels = this.canvas.width / this.canvas.clientWidth, { right, up, toEye, middle } = this;
        const across = (x * pixels - this.canvas.width / 2) / this.scale, along = (this.canvas.height / 2 - y * pixels) / this.scale;
        const p = [0, 1, 2].map((i) => middle[i]! + across * right[i]! + along * up[i]!);
        const far = p[2]! / Math.max(toEye[2], 0.05);
        return [p[0]! - far * toEye[0], p[1]! - far * toEye[1], 0];
    }

    private depth(x: number, y: number, z: number): number { return x * this.toEye[0] + y * this.toEye[1] + z * this.toEye[2]; }

    /** Triangles of vertices with `stride` floats each, coloured by their index. A ball, if there is one, stands among them. */
    surface(positions: Float32Array, stride: number, triangles: Uint32Array, colour: (triangle: number) => Rgb, edges = 0, ball: { at: Point; radius: number } | null = null): void {
        const count = triangles.length / 3, order = new Uint32Array(count), depths = new Float32Array(count), { pen } = this;
        const corner = (k: number): Point => [positions[stride * k]!, positions[stride * k + 1]!, positions[stride * k + 2]!];
        for (let t = 0; t < count; t++) {
            order[t] = t;
            for (let k = 0; k < 3; k++) depths[t]! += this.depth(...corner(triangles[3 * t + k]!)) / 3;
        }
        order.sort((a, b) => depths[a]! - depths[b]!);
        let waiting = ball;
        const ballDepth = ball ? this.depth(...ball.at) : 0;
        pen.lineWidth = edges || 0.8;
        for (const t of order) {
            if (waiting && depths[t]! > ballDepth) {
                this.ball(waiting.at, waiting.radius);
                waiting = null;
                pen.lineWidth = edges || 0.8;
            }
            const [a, b, c] = [corner(triangles[3 * t]!), corner(triangles[3 * t + 1]!), corner(triangles[3 * t + 2]!)];
            const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]] as const, v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]] as const;
            const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]] as const;
            const length = Math.hypot(...normal) || 1, [ex, ey, ez] = this.toEye;
            const light = (Math.abs(0.35 * normal[0] - 0.2 * normal[1] + 0.915 * normal[2]) + Math.abs(ex * normal[0] + ey * normal[1] + ez * normal[2])) / (2 * length);
            const fill = css(colour(t), 0.3 + 0.7 * light);
            pen.fillStyle = fill;
            pen.strokeStyle = edges ? "rgb(7 5 5 / .55)" : fill; // its own colour hides the seams
            pen.beginPath();
            pen.moveTo(...this.flat(...a));
            pen.lineTo(...this.flat(...b));
            pen.lineTo(...this.flat(...c));
            pen.closePath();
            pen.fill();
            pen.stroke();
        }
        if (waiting) this.ball(waiting.at, waiting.radius);
    }

    /** Lines between pairs of points, one colour each. */
    lines(pairs: Iterable<readonly [Point, Point, Rgb]>, width: number): void {
        const { pen } = this;
        pen.lineWidth = width * Math.min(devicePixelRatio, 2);
        for (const [a, b, colour] of pairs) {
            pen.strokeStyle = css(colour, 1);
            pen.beginPath();
            pen.moveTo(...this.flat(...a));
            pen.lineTo(...this.flat(...b));
            pen.stroke();
        }
    }

    dots(points: Iterable<readonly [Point, Rgb]>, size: number): void {
        const { pen } = this, radius = size * Math.min(devicePixelRatio, 2);
        for (const [point, colour] of points) {
            pen.fillStyle = css(colour, 1);
            pen.beginPath();
            pen.arc(...this.flat(...point), radius, 0, 2 * Math.PI);
            pen.fill();
        }
    }

    private ball(at: Point, radius: number): void {
        const { pen } = this, [x, y] = this.flat(...at), r = radius * this.scale;
        const glow = pen.createRadialGradient(x - 0.35 * r, y - 0.45 * r, 0.1 * r, x, y, r);
        glow.addColorStop(0, "#8d7e70");
        glow.addColorStop(1, "#2a221d");
        pen.fillStyle = glow;
        pen.beginPath();
        pen.arc(x, y, r, 0, 2 * Math.PI);
        pen.fill();
    }
}
