// Files dropped anywhere on the page go to the panel that takes their kind; without this the
// browser would leave the page and show the file.
const MOST = 256 << 20; // bytes

export class Drops {
  constructor(viewport) {
    this.viewport = viewport;
    this.over = (e) => this.drag(e);
    this.done = (e) => this.drop(e);
    window.addEventListener("dragover", this.over);
    window.addEventListener("drop", this.done);
  }

  drag(e) {
    e.preventDefault();
  }

  async drop(e) {
    if (e.defaultPrevented) return; // a field for uploads has taken it
    e.preventDefault();
    const files = [...(e.dataTransfer?.files ?? [])];
    // A head before its landmarks.
    files.sort((a, b) => a.name.endsWith(".json") - b.name.endsWith(".json"));
    for (const file of files) await this.send(file);
  }

  async send(file) {
    const ending = /\.[^.]+$/.exec(file.name.toLowerCase())?.[0];
    const address = this.viewport.settings.drops[ending];
    if (!address || file.size > MOST) {
      this.viewport.emit("strange", { name: file.name, big: Number(file.size > MOST) });
      return;
    }
    const form = new FormData();
    form.append("file", file);
    await fetch(address, { method: "POST", body: form });
  }

  close() {
    window.removeEventListener("dragover", this.over);
    window.removeEventListener("drop", this.done);
  }
}
