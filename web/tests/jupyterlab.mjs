// The notebook's widget in JupyterLab itself, in Chromium: cells are run as by hand, and what they show is looked at.
//
// usage: node jupyterlab.mjs PYTHON FOLDER_OF_A_RUN [PICTURE.png]     PYTHON imports jupyterlab, singe, anywidget and numpy
import { spawn } from "node:child_process";
import { mkdir, mkdtemp, rm, writeFile } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";
import { CHROMIUM, CHROMIUM_ARGS } from "./browsers.mjs";

const [, , python, folder, picture] = process.argv;
const PATIENCE = 120_000; // ms
const CELLS = [
    `import singe\nburn = singe.read_cache(${JSON.stringify(resolve(folder))})\n`
        + "widget = singe.view(burn, height=520)\nprint('server', widget.server._child.pid)\nwidget",
    "broken = singe.view(burn)\nbroken.server.close()\nbroken",
];

// ---- JupyterLab, with settings, kernels and a notebook of its own, which asks nobody for news

const work = await mkdtemp(join(tmpdir(), "singe-jupyterlab-")), root = join(work, "notebooks");
const own = Object.fromEntries(["JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR"].map((name) => [name, join(work, name)]));
await mkdir(root);
await mkdir(join(own.JUPYTER_CONFIG_DIR, "labconfig"), { recursive: true });
await writeFile(join(own.JUPYTER_CONFIG_DIR, "labconfig", "page_config.json"),
    JSON.stringify({ disabledExtensions: { "@jupyterlab/apputils-extension:announcements": true } }));
await writeFile(join(root, "burn.ipynb"), JSON.stringify({
    nbformat: 4, nbformat_minor: 5,
    metadata: { kernelspec: { name: "python3", display_name: "Python 3", language: "python" } },
    cells: CELLS.map((source, i) => ({ cell_type: "code", id: `cell-${i}`, metadata: {}, execution_count: null, outputs: [], source })),
}));

const port = await new Promise((found) => {
    const probe = createServer().listen(0, "127.0.0.1", () => {
        const { port } = probe.address();
        probe.close(() => found(port));
    });
});
const token = `${Math.random()}`, home = `http://127.0.0.1:${port}/`;
const lab = spawn(python, ["-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1", `--port=${port}`, "--ServerApp.port_retries=0",
    `--IdentityProvider.token=${token}`, `--ServerApp.root_dir=${root}`],
    { env: { ...process.env, ...own }, stdio: ["ignore", "ignore", "pipe"] });
let said = "";
lab.stderr.on("data", (bytes) => { said += bytes; });
const ended = new Promise((done) => lab.once("exit", done));
const ask = async (path, method = "GET") => {
    const response = await fetch(`${home}${path}?token=${token}`, { method });
    return response.status === 204 ? null : response.json();
};

let bad = 0;
const check = (what, good) => {
    console.log(`${good ? "ok  " : "BAD "} ${what}`);
    bad += !good;
};
async function until(call) {
    for (const end = Date.now() + PATIENCE; Date.now() < end; await new Promise((done) => setTimeout(done, 100))) {
        const value = await Promise.resolve().then(call).catch(() => null);
        if (value) return value;
    }
    return null;
}
const runs = (pid) => {
    try {
        return process.kill(pid, 0);
    } catch {
        return false;
    }
};

/** What the screen shows in the middle of the cell, beside the buttons: the share of pixels that differ from the first; 0 is blank. */
async function drawn(page, frame) {
    const { x, y, width, height } = await frame.boundingBox();
    const shot = await page.screenshot({ clip: { x: x + 0.2 * width, y: y + 0.15 * height, width: 0.4 * width, height: 0.45 * height } });
    return page.evaluate(async (png) => {
        const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
        const draw = new OffscreenCanvas(image.width, image.height).getContext("2d");
        draw.drawImage(image, 0, 0);
        const { data } = draw.getImageData(0, 0, image.width, image.height);
        let others = 0;
        for (let i = 0; i < data.length; i += 4) {
            others += [0, 1, 2].some((channel) => Math.abs(data[i + channel] - data[channel]) > 40);
        }
        return others / (data.length / 4);
    }, shot.toString("base64"));
}

let browser;
try {
    await until(async () => lab.exitCode !== null || (await ask("api")).version);
    if (lab.exitCode !== null) throw new Error(`JupyterLab ended:\n${said}`);
    browser = await chromium.launch({ executablePath: CHROMIUM, args: CHROMIUM_ARGS });
    const page = await browser.newPage({ viewport: { width: 1280, height: 1000 } }), errors = [], outside = [];
    page.setDefaultTimeout(PATIENCE);
    page.on("pageerror", (error) => errors.push(error.message));
    page.on("request", (request) => /^https?:/.test(request.url()) && !request.url().startsWith(home) && outside.push(request.url()));
    await page.goto(`${home}lab/tree/burn.ipynb?token=${token}`);
    await page.waitForSelector('.jp-Notebook-ExecutionIndicator[data-status="idle"]'); // before that a cell is not run

    /** Runs a cell by Shift+Enter, again where JupyterLab was too busy to hear it, and returns where its output comes. */
    const shown = async (number) => {
        const one = page.locator(".jp-CodeCell").nth(number), prompt = one.locator(".jp-InputPrompt");
        const heard = await until(async () => {
            await one.locator(".cm-content").click();
            await page.keyboard.press("Shift+Enter");
            await page.waitForTimeout(3000);
            return (await prompt.textContent()) !== "[ ]:";
        });
        if (!heard) throw new Error(`cell ${number} is not run`);
        return one.locator(".jp-OutputArea");
    };
    const first = await shown(0);
    const frame = await page.waitForSelector('iframe[title="singe view"]').catch(async () => {
        throw new Error(`no view, but: ${await first.textContent({ timeout: 1000 }).catch(() => "nothing")}`);
    });
    const cell = await frame.contentFrame();
    check("the view is ready", await until(() => cell.evaluate(() => document.getElementById("view").classList.contains("ready"))));
    check("the burn is seen", await until(async () => (await drawn(page, frame)) > 0.1));
    await cell.evaluate(() => { document.getElementById("view").style.visibility = "hidden"; });
    check("its canvas is what is seen", await until(async () => (await drawn(page, frame)) === 0));
    await cell.evaluate(() => { document.getElementById("view").style.visibility = ""; });

    const last = await until(() => cell.evaluate(() => Number(document.getElementById("time").max)));
    check(`it has ${last} frames`, last > 1);
    await cell.locator("#time").focus();
    await page.keyboard.press("End");
    check("the last one is shown", await until(() => cell.evaluate((last) => document.getElementById("at").textContent.startsWith(`${last} `), last)));
    if (picture) {
        await page.waitForTimeout(1000);
        await page.screenshot({ path: picture });
    }
    const server = Number(/server (\d+)/.exec(await first.textContent())?.[1]);
    check("a server runs for it", runs(server));

    const second = await shown(1);
    check("a view that lost its server says so", await until(async () => (await second.textContent()).includes("singe view does not answer")));

    check(`the browser asks nobody else ${outside.join(" ")}`, outside.length === 0);
    check(`no errors ${errors.join("; ")}`, errors.length === 0);
    for (const { id } of await ask("api/kernels")) await ask(`api/kernels/${id}`, "DELETE");
    check("the server ends with the kernel", await until(() => !runs(server)));
} finally {
    await browser?.close();
    lab.kill("SIGTERM");
    await ended;
    await rm(work, { recursive: true, force: true });
}
process.exit(bad ? 1 : 0);
