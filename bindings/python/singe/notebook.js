// The view of `singe view` in a notebook's cell. Its page, its modules and its data come through the kernel, by messages
// {id, path}, from the server that the kernel has started, so that nothing but the kernel need reach it.
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

    const imports = /from "\.\/(\w+)\.js"/g;
    /** A module as an object of the browser, after those that it imports. */
    const load = async (name) => {
        const code = await text(`${name}.js`);
        for (const [, other] of code.matchAll(imports)) urls[other] ??= await load(other);
        return URL.createObjectURL(new Blob([code.replace(imports, (_, other) => `from "${urls[other]}"`)], { type: "text/javascript" }));
    };

    const frame = document.createElement("iframe");
    frame.title = "singe view";
    frame.style.cssText = `width: 100%; height: ${model.get("height")}px; border: 0; display: block`;
    frame.ask = ask;
    el.append(frame);

    (async () => {
        urls.view = await load("view");
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
