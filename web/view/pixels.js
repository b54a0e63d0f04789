// How many pixels are drawn, as a share of all along each side: as many as the card draws in time while things move, and all
// of what stands still. The page and `singe view` wait by it until the card is done, so that no drawings queue up.

const SHARES = [0.35, 0.5, 0.7, 0.85, 1];
const IN_TIME = [Infinity, 32, 15, 15, 15]; // ms: 60 frames a second, or where pixels would be seen, 30
const TRIES = { fewer: 3, more: 6, most: 600 }; // drawings in a row
const SETTLES = 3; // drawings after a change, in which the card also makes its pictures anew
const STILL = 250; // ms

export class Pixels {
    #gl;
    #level = 0; // the first drawings also compile programs
    #fence = null;
    #streak = 0; // drawings in a row that were in time for more pixels, or negative, too slow
    #settling = 0;
    #patience = TRIES.more; // drawings until more pixels are tried, more after each try that failed
    #moved = 0;
    #whole = false;
    /** A share that tests ask for. @type {number | null} */
    fixed = null;
    /** Whether the share is not to change. */
    held = false;

    /** @param {WebGL2RenderingContext} gl */
    constructor(gl) { this.#gl = gl; }

    get share() { return this.fixed ?? (this.#whole ? 1 : SHARES[this.#level]); }
    /** Whether the card has drawn all that it was asked for. */
    get free() { return !this.#fence; }

    /** To be called before a drawing. @param {boolean} whole all pixels, as nothing moves */
    begin(now, whole = false) {
        this.#whole = whole;
        if (!whole) this.#moved = now;
    }

    /** Whether what was drawn with fewer pixels has stood still for a while. */
    rests(now) { return this.fixed === null && !this.held && this.free && this.share < 1 && now - this.#moved > STILL; }

    /** To be called after a drawing: measures how long the card takes. @param {(() => void) | null} then called when it is seen */
    end(then = null) {
        const gl = this.#gl, begun = performance.now(), fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        if (!fence) return; // the context is lost
        this.#fence = fence;
        gl.flush();
        const look = () => {
            if (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) return setTimeout(look, 1);
            gl.deleteSync(fence);
            if (this.#fence === fence) this.#fence = null;
            then?.();
            if (!this.#whole && !document.hidden) this.took(performance.now() - begun);
        };
        setTimeout(look, 1);
    }

    /** A drawing took so many ms. */
    took(ms) {
        if (this.fixed !== null || this.held) return;
        if (this.#settling > 0) return void this.#settling--;
        const level = this.#level, next = level + 1, more = (1 + (SHARES[next] / SHARES[level]) ** 2) / 2; // half of the time is for pixels
        const slow = ms > IN_TIME[level], fast = next < SHARES.length && more * ms < IN_TIME[next];
        this.#streak = slow ? Math.min(this.#streak, 0) - 1 : fast ? Math.max(this.#streak, 0) + 1 : 0;
        const by = this.#streak <= -TRIES.fewer ? -1 : this.#streak >= this.#patience ? 1 : 0;
        if (!by) return;
        if (by < 0) this.#patience = Math.min(4 * this.#patience, TRIES.most);
        this.#settling = SETTLES;
        this.#level += by;
        this.#streak = 0;
    }
}
