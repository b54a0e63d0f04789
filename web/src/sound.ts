// The sound of the fire, made of noise: a hiss as loud as it burns, and crackles that come by chance, more of them the
// more burns. A tear is a crackle of its own.
const SECONDS = 2; // of noise, played again and again
const MOST_CRACKLES = 14; // in a frame

export class FireSound {
    private noise: AudioBuffer;
    private hiss: GainNode;
    private all: GainNode;
    private tears = 0;
    private due = 0; // crackles that have yet to come, less than one

    /** Make the context in a click: browsers keep pages silent until then. */
    constructor(private context: BaseAudioContext) {
        this.noise = context.createBuffer(1, SECONDS * context.sampleRate, context.sampleRate);
        const samples = this.noise.getChannelData(0);
        for (let i = 0; i < samples.length; i++) samples[i] = 2 * Math.random() - 1;
        this.all = new GainNode(context, { gain: 0.5 });
        this.all.connect(context.destination);
        this.hiss = new GainNode(context, { gain: 0 });
        const source = new AudioBufferSourceNode(context, { buffer: this.noise, loop: true });
        source.connect(new BiquadFilterNode(context, { type: "lowpass", frequency: 900, Q: 0.3 })).connect(new BiquadFilterNode(context, { type: "highpass", frequency: 90 }))
            .connect(this.hiss).connect(this.all);
        source.start();
    }

    /** `burning` cells burn, there were `tears` so far, and `seconds` have passed since the frame before. Returns the
     * number of crackles. */
    hear(burning: number, tears: number, seconds: number): number {
        const { context } = this, now = context.currentTime;
        this.hiss.gain.setTargetAtTime(Math.min(0.22, 0.012 * Math.sqrt(burning)), now, 0.15);
        this.due += Math.min(40, 0.7 * Math.sqrt(burning)) * seconds;
        let count = 0;
        for (; this.due >= 1 && count < MOST_CRACKLES; this.due--, count++) this.crackle(now + seconds * Math.random(), 0.08 + 0.25 * Math.random() ** 4);
        for (let i = Math.min(tears - this.tears, MOST_CRACKLES); i > 0; i--, count++) this.crackle(now + 0.03 * i, 0.4);
        this.tears = tears;
        this.due = Math.min(this.due, 1);
        return count;
    }

    private crackle(at: number, loudness: number): void {
        const { context } = this, length = 0.004 + 0.02 * Math.random();
        const gain = new GainNode(context, { gain: loudness }), source = new AudioBufferSourceNode(context, { buffer: this.noise });
        gain.gain.setValueAtTime(loudness, at);
        gain.gain.exponentialRampToValueAtTime(1e-3, at + length);
        source.connect(new BiquadFilterNode(context, { type: "bandpass", frequency: 1200 + 5200 * Math.random(), Q: 1.5 })).connect(gain).connect(this.all);
        source.start(at, SECONDS * Math.random(), length + 0.01);
    }
}
