// A film of canvases as WebM, by WebCodecs: each picture has its own time, however long it took to draw.

const CODECS = { "vp09.00.51.08": "V_VP9", vp8: "V_VP8" };
const KEY_EVERY = 48; // frames

/** What an EBML element is called. */
const ID = {
    ebml: 0x1a45dfa3, docType: 0x4282, docVersion: 0x4287, readVersion: 0x4285, segment: 0x18538067, info: 0x1549a966, scale: 0x2ad7b1, duration: 0x4489,
    muxer: 0x4d80, writer: 0x5741, tracks: 0x1654ae6b, entry: 0xae, number: 0xd7, uid: 0x73c5, type: 0x83, codec: 0x86, video: 0xe0, width: 0xb0,
    height: 0xba, cluster: 0x1f43b675, time: 0xe7, block: 0xa3,
};

const bigEndian = (value, length) => Array.from({ length }, (_, i) => Math.floor(value / 256 ** (length - 1 - i)) % 256);
/** An element as a list of parts; sizes take eight bytes. */
function element(name, ...parts) {
    const id = ID[name], flat = parts.flat(9), size = flat.reduce((sum, part) => sum + part.length, 0);
    return [Uint8Array.from([...bigEndian(id, Math.ceil(Math.log2(id + 1) / 8)), 1, ...bigEndian(size, 7)]), ...flat];
}
const number = (name, value) => element(name, Uint8Array.from(bigEndian(value, 4)));
const text = (name, words) => element(name, new TextEncoder().encode(words));
function real(name, value) {
    const bytes = new Uint8Array(8);
    new DataView(bytes.buffer).setFloat64(0, value);
    return element(name, bytes);
}

/** @param {{time: number, key: boolean, bytes: Uint8Array}[]} pictures times in ms, the first a key frame */
export function webmOf(codec, width, height, length, pictures) {
    const clusters = [];
    for (const { time, key, bytes } of pictures) {
        if (key) clusters.push({ time, blocks: [] });
        const { time: begin, blocks } = clusters[clusters.length - 1], head = [0x81, ...bigEndian(time - begin, 2), key ? 0x80 : 0];
        blocks.push(element("block", Uint8Array.from(head), bytes));
    }
    const parts = [
        element("ebml", text("docType", "webm"), number("docVersion", 4), number("readVersion", 2)),
        element("segment",
            element("info", number("scale", 1e6), real("duration", length), text("muxer", "singe"), text("writer", "singe")),
            element("tracks", element("entry", number("number", 1), number("uid", 1), number("type", 1), text("codec", codec),
                element("video", number("width", width), number("height", height)))),
            clusters.map(({ time, blocks }) => element("cluster", number("time", time), blocks))),
    ];
    return new Blob(parts.flat(9), { type: "video/webm" });
}

export class Film {
    pictures = [];
    count = 0;

    /** Null where the browser cannot encode. */
    static async make(canvas, fps) {
        if (!globalThis.VideoEncoder) return null;
        const width = canvas.width & ~1, height = canvas.height & ~1;
        for (const codec of Object.keys(CODECS)) {
            const config = { codec, width, height, bitrate: Math.min(24e6, 8e6 + 8 * width * height), framerate: fps };
            const { supported } = await VideoEncoder.isConfigSupported(config).catch(() => ({ supported: false }));
            if (supported) return new Film(canvas, fps, config);
        }
        return null;
    }

    constructor(canvas, fps, config) {
        Object.assign(this, { canvas, fps, config, error: null });
        this.encoder = new VideoEncoder({
            output: (chunk) => {
                const bytes = new Uint8Array(chunk.byteLength);
                chunk.copyTo(bytes);
                this.pictures.push({ time: Math.round(chunk.timestamp / 1000), key: chunk.type === "key", bytes });
            },
            error: (error) => { this.error = error; },
        });
        this.encoder.configure(config);
    }

    /** The canvas as it is now, one frame after the last. */
    add() {
        const { width, height } = this.config, at = (1e6 * this.count) / this.fps;
        if (this.canvas.width < width || this.canvas.height < height) throw new Error("the window became smaller");
        const picture = new VideoFrame(this.canvas, { timestamp: Math.round(at), visibleRect: { x: 0, y: 0, width, height } });
        this.encoder.encode(picture, { keyFrame: this.count % KEY_EVERY === 0 });
        picture.close();
        this.count++;
    }

    async end() {
        await this.encoder.flush();
        this.encoder.close();
        if (this.error) throw this.error;
        return webmOf(CODECS[this.config.codec], this.config.width, this.config.height, (1000 * this.count) / this.fps, this.pictures);
    }
}
