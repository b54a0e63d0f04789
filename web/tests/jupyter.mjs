// The widget in JupyterLab, in Chromium: a cell is run, and the view is in its output.
//
// usage: node jupyter.mjs PYTHON FOLDER_OF_A_RUN [PICTURE.png]     PYTHON has jupyterlab, anywidget, numpy, and imports singe
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { chromium } from "playwright-core";
import { CHROMIUM, CHROMIUM_ARGS } from "./browsers.mjs";

const [, , python, folder, picture] = process.argv, PATIENCE = 300_000;
const work = await mkdtemp(join(tmpdir(), "singe-jupyter-"));
const cell = { cell_type: "code", execution_count: null, metadata: {}, outputs: [], source: `import singe\nsinge.view(singe.read_cache(${JSON.stringify(folder)}), height=420)` };
await writeFile(join(work, "burn.ipynb"), JSON.stringify({ cells: [cell], metadata: { kernelspec: { name: "python3", display_name: "Python 3", language: "python" } }, nbformat: 4, nbformat_minor: 4 }));

const server = spawn(python, ["-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1", "--port=0", "--IdentityProvider.token=burn", `--ServerApp.root_dir=${work}`], {
    stdio: ["ignore", "ignore", "pipe"], env: { ...process.env, HOME: work, JUPYTER_CONFIG_DIR: work },
});
const address = await new Promise((resolve, reject) => {
    createInterface({ input: server.stderr }).on("line", (line) => { const found = line.match(/http:\/\/127\.0\.0\.1:\d+\//); if (found) resolve(found[0]); });
    server.once("exit", () => reject(new Error("JupyterLab ended")));
});
const browser = await chromium.launch({ executablePath: CHROMIUM, args: CHROMIUM_ARGS });
try {
    const page = await browser.newPage({ viewport: { width: 1000, height: 760 } });
    page.setDefaultTimeout(PATIENCE);
    page.setDefaultNavigationTimeout(PATIENCE);
    await page.goto(`${address}lab/tree/burn.ipynb?token=burn`);
    await page.waitForSelector(".jp-Notebook .jp-CodeCell");
    await page.click(".jp-Notebook .jp-CodeCell .cm-content");
    await page.waitForFunction(() => /Idle/.test(document.querySelector(".jp-Notebook-ExecutionIndicator")?.dataset.status ?? "idle"), null, { timeout: PATIENCE }).catch(() => {});
    await page.keyboard.press("Shift+Enter");
    const frame = await (await page.waitForSelector(".jp-OutputArea iframe")).contentFrame();
    await frame.waitForSelector("#view.ready");
    await frame.evaluate(() => globalThis.view.quality(0.2) /* drawn without a card */);
    const last = await frame.evaluate(() => globalThis.view.state.last);
    await frame.evaluate((f) => globalThis.view.goTo(f), last);
    await frame.waitForFunction((f) => globalThis.view.state.shown === f, last);
    assert.ok(last > 1, `${last} frames`);
    if (picture) await page.screenshot({ path: picture });
    console.log(`ok   a cell of JupyterLab shows the burn, and goes to frame ${last}`);
} finally {
    await browser.close();
    server.kill("SIGTERM");
    await rm(work, { recursive: true, force: true, maxRetries: 5 });
}
