// Pictures of `singe view` in Chromium for docs/view.md: node tests/pictures.mjs CACHE FOLDER
//
// CACHE is the letter's. view-letter.webp is the page at frame 50; view-preview.webp is frame 70 beside the preview's. Prints
// the mean red, green and blue of both, over all and over the lowest fifth, where the table is.
import { execFileSync, spawn } from "node:child_process";
import { mkdir, mkdtemp, readdir, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { BROWSERS, until } from "./browsers.mjs";

const PAGE = 50, BESIDE = 70;
const [cache, folder] = process.argv.slice(2), SINGE = process.env.SINGE ?? new URL("../../build/singe", import.meta.url).pathname;
const work = await mkdtemp(join(tmpdir(), "singe-pictures-")), server = spawn(SINGE, ["view", cache], { stdio: ["ignore", "pipe", "inherit"] });
const address = await new Promise((resolve) => createInterface(server.stdout).once("line", resolve)), page = await BROWSERS.Chromium();
const ffmpeg = (...words) => execFileSync("ffmpeg", ["-y", "-loglevel", "error", ...words]);
const goTo = async (frame) => {
    await page.evaluate((f) => globalThis.view.goTo(f), frame);
    await until(page, (f) => globalThis.view.state.shown === f, frame, `frame ${frame} is shown`);
};
try {
    await mkdir(folder, { recursive: true });
    await page.size(1280, 720);
    await page.open(address);
    await until(page, () => Boolean(globalThis.view), null, "the page starts");
    await page.evaluate(() => globalThis.view.quality(0.1));
    await until(page, () => document.querySelector("#view").classList.contains("ready"), null, "a frame is shown");
    await goTo(PAGE);
    await page.evaluate(() => globalThis.view.quality(1));
    await page.picture(join(work, "page.png"));
    ffmpeg("-i", join(work, "page.png"), "-quality", "85", join(folder, "view-letter.webp"));

    await page.evaluate(() => globalThis.view.quality(0.1));
    await goTo(BESIDE);
    const drawn = await page.evaluate(() => {
        const { stage, camera } = globalThis.view;
        stage.resize(stage.room.width, stage.room.height);
        stage.draw(camera);
        return stage.canvas.toDataURL("image/png");
    });
    await writeFile(join(work, "view.png"), Buffer.from(drawn.split(",")[1], "base64"));
    execFileSync(SINGE, ["render", cache, "--frames", String(BESIDE), "-o", work], { stdio: "pipe" });
    const [preview] = await readdir(join(work, "frames")), both = [["view", join(work, "view.png")], ["preview", join(work, "frames", preview)]];
    ffmpeg(...both.flatMap(([, path]) => ["-i", path]), "-filter_complex", "hstack", "-quality", "90", join(folder, "view-preview.webp"));
    for (const [name, path] of both) {
        const means = ["scale=1:1:flags=area", "crop=iw:ih/5:0:4*ih/5,scale=1:1:flags=area"].map((filter) => [...ffmpeg("-i", path, "-vf", `${filter},format=rgb24`, "-f", "rawvideo", "-")].join(" "));
        console.log(`${name}: red, green and blue ${means[0]} of 255, the table's ${means[1]}`);
    }
} finally {
    await page.close();
    server.kill("SIGINT");
    await rm(work, { recursive: true, force: true });
}
