// Serves dist on the loopback: node serve.mjs [PORT]. Any other static host does as well.
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";

const ROOT = new URL("./dist/", import.meta.url).pathname;
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".png": "image/png", ".jpg": "image/jpeg" };

/** The server and its address; port 0 is a free one. */
export function serve(port = 0) {
    const server = createServer(async (request, response) => {
        const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname)), file = join(ROOT, path === "/" ? "index.html" : path);
        try {
            if (!file.startsWith(ROOT)) throw new Error("outside");
            const bytes = await readFile(file);
            response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" });
            response.end(bytes);
        } catch {
            response.writeHead(404);
            response.end("not found");
        }
    });
    return new Promise((resolve) => server.listen(port, "127.0.0.1", () => resolve({ server, address: `http://127.0.0.1:${server.address().port}/` })));
}

if (process.argv[1] === new URL(import.meta.url).pathname) console.log((await serve(Number(process.argv[2] ?? 8080))).address);
