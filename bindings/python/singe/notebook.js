// The view of `singe view` in a notebook's cell. Its page, its modules and its data come through the kernel, by messages
// {id, path}, from the server that the kernel has started, so that nothing but the kernel need reach it.
const MODULES = ["math", "tables", "shaders", "frame", "plots", "stage", "view"]; // each after those that it imports
let views = 0;

function render({ model, el }) {
    const mine = `${++views}-${Math.random()}`, waiting = new Map(), urls = {};
    let asked = 0, closed = false;
    const answer = ({ id, status }, buffers) => {
        waiting.get(id)?.(new Response(buffers[0], { status }));
        waiting.delete(id);
    };
    model.on("msg:custom", answer);
    const ask = (path) => new Promise((resolve) => {
        const id = `${mine}-${++asked}`;
        waiting.set(id, resolve);
        model.send({ id, path });
    });
    const text = async (path) => {
        const response = await ask(path), said = await response.text();
        if (!response.ok) throw new Error(said);
        return said;
    };

    const frame = document.createElement("iframe");
    frame.title = "singe view";
    frame.style.cssText = `width: 100%; height: ${model.get("height")}px; border: 0; display: block`;
    frame.ask = ask;
    el.append(frame);

    (async () => {
        for (const name of MODULES) {
            const code = (await text(`${name}.js`)).replace(/from "\.\/(\w+)\.js"/g, (_, other) => `from "${urls[other]}"`);
            urls[name] = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
        }
        const style = await text("view.css"), page = await text("index.html");
        if (closed) return;
        frame.srcdoc = page
            .replace(/<link rel="stylesheet"[^>]*>/, () => `<style>${style}</style><script>fetch = (path) => frameElement.ask(path)</script>`)
            .replace('src="view.js"', () => `src="${urls.view}"`);
    })().catch((error) => el.replaceChildren(`singe view: ${error.message}`));

    return () => {
        closed = true;
        model.off("msg:custom", answer);
        frame.remove();
        for (const url of Object.values(urls)) URL.revokeObjectURL(url);
    };
}

export default { render };
