// A frame as `singe view` shows it in Chromium beside the preview's: node tests/beside.mjs CACHE FRAME PICTURE
//
// Prints the mean red, green and blue of both, over all and over the lowest fifth, where the ground is.
import { execFileSync, spawn } from "node:child_process";
import { mkdtemp, readdir, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { BROWSERS, until } from "./browsers.mjs";

const [cache, number, picture] = process.argv.slice(2), SINGE = process.env.SINGE ?? new URL("../../build/singe", import.meta.url).pathname;
const work = await mkdtemp(join(tmpdir(), "singe-beside-")), server = spawn(SINGE, ["view", cache], { stdio: ["ignore", "pipe", "inherit"] });
const address = await new Promise((resolve) => createInterface(server.stdout).once("line", resolve)), page = await BROWSERS.Chromium();
try {
    await page.open(address);
    await until(page, () => Boolean(globalThis.view), null, "the page starts");
    await page.evaluate(() => globalThis.view.quality(0.1));
    await until(page, () => document.querySelector("#view").classList.contains("ready"), null, "a frame is shown");
    await page.evaluate((frame) => globalThis.view.goTo(frame), Number(number));
    const drawn = await page.evaluate(() => {
        const { stage, camera } = globalThis.view;
        stage.resize(stage.room.width, stage.room.height);
        stage.draw(camera);
        return stage.canvas.toDataURL("image/png");
    });
    await writeFile(join(work, "view.png"), Buffer.from(drawn.split(",")[1], "base64"));
    execFileSync(SINGE, ["render", cache, "--frames", number, "-o", work], { stdio: "pipe" });
    const ffmpeg = (...words) => execFileSync("ffmpeg", ["-y", "-loglevel", "error", ...words]);
    const preview = join(work, "frames", (await readdir(join(work, "frames")))[0]);
    ffmpeg("-i", join(work, "view.png"), "-i", preview, "-filter_complex", "hstack", "-quality", "90", picture);
    for (const [name, path] of [["view", join(work, "view.png")], ["preview", preview]]) {
        const means = ["scale=1:1:flags=area", "crop=iw:ih/5:0:4*ih/5,scale=1:1:flags=area"].map((filter) => [...ffmpeg("-i", path, "-vf", `${filter},format=rgb24`, "-f", "rawvideo", "-")].join(" "));
        console.log(`${name}: red, green and blue ${means[0]} of 255, the ground's ${means[1]}`);
    }
} finally {
    await page.close();
    server.kill("SIGINT");
    await rm(work, { recursive: true, force: true });
}
