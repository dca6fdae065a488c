// The element that NiceGUI places on the page; everything it does stands in the modules.
import { Viewport } from "risorius-studio";

export default {
  template: `
    <div class="rv-root">
      <canvas class="rv-canvas"></canvas>
      <div class="rv-labels"></div>
      <div class="rv-tip"></div>
      <div class="rv-lost">connection lost, trying again …</div>
    </div>`,
  props: { stream: String },
  mounted() {
    this.viewport = new Viewport(this.$el, this.stream, (name, data) => this.$emit(name, data));
    window.risoriusViewport = this.viewport;
  },
  unmounted() {
    this.viewport.close();
  },
  methods: {
    set(settings) { this.viewport.set(settings); },
    overlay(content) { this.viewport.overlay.show(content); },
    look(preset) { this.viewport.views.look(preset); },
    choose(marks) { this.viewport.mark(marks); },
    rest() { this.viewport.player.rest(); },
    picture(name) { this.viewport.picture(name); },
  },
};
