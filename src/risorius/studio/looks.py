"""Colours and measures of the page."""

from __future__ import annotations

__all__ = ["ACCENT", "CSS"]

ACCENT = "#e08a63"

CSS = """
:root { --bg:#16181b; --panel:#1f2226; --line:#2e3238; --text:#d9dbde; --dim:#8d939b;
  --accent:#e08a63; --good:#7fb48a; }
html, body { height:100%; overflow:hidden; background:var(--bg); color:var(--text); }
body, .q-btn, .q-field { font-family: Roboto, system-ui, sans-serif; font-size:13px; }
.nicegui-content { padding:0 !important; height:100vh; gap:0; }
.st-top { height:46px; width:100%; display:flex; align-items:center; gap:4px; padding:0 10px;
  background:var(--panel); border-bottom:1px solid var(--line); flex:none; }
.st-brand { font-size:16px; letter-spacing:.04em; color:var(--accent); margin-right:10px; }
.st-file { color:var(--text); max-width:190px; overflow:hidden; text-overflow:ellipsis;
  white-space:nowrap; }
.st-kept { color:var(--dim); margin-left:6px; white-space:nowrap; }
.st-sep { width:1px; height:22px; background:var(--line); margin:0 8px; }
.st-body { display:flex; width:100%; height:calc(100vh - 46px); }
.st-tabs { width:66px; flex:none; background:var(--panel); border-right:1px solid var(--line); }
.st-tabs .q-tab { min-height:58px; padding:0 2px; color:var(--dim); }
.st-tabs .q-tab--active { color:var(--accent); background:#262a2f; }
.st-tabs .q-tab__label { font-size:10.5px; text-transform:none; }
.st-panel { width:330px; flex:none; height:100%; overflow-y:auto; background:var(--panel);
  border-right:1px solid var(--line); }
.st-panel .q-tab-panels, .st-panel .q-tab-panel { background:transparent; padding:0; }
.st-panel .q-tab-panel > .nicegui-column, .st-stack { gap:10px; padding:14px; width:100%; }
.st-view { flex:1; position:relative; min-width:0; height:100%; }
.st-title { font-size:15px; font-weight:500; }
.st-help { color:var(--dim); line-height:1.4; }
.st-warn { color:#f0a08f; line-height:1.4; overflow-wrap:anywhere; }
.st-group { width:100%; border:1px solid var(--line); border-radius:8px; padding:8px 10px;
  gap:4px; background:#23272c; }
.st-head { font-size:11px; letter-spacing:.07em; text-transform:uppercase; color:var(--dim); }
.st-row { display:grid; grid-template-columns:118px 1fr 38px; align-items:center; width:100%;
  min-height:27px; column-gap:10px; }
.st-row.two { grid-template-columns:118px 1fr 1fr; }
.st-name { white-space:nowrap; overflow:hidden; text-overflow:ellipsis; }
.st-number { color:var(--dim); white-space:nowrap; text-align:right;
  font-variant-numeric:tabular-nums; }
.st-hint { position:absolute; left:12px; bottom:12px; max-width:calc(100% - 24px);
  background:rgba(20,22,25,.86); border:1px solid var(--line); border-radius:8px;
  padding:7px 12px; color:var(--text); pointer-events:none; }
.st-hint b { color:var(--accent); font-weight:500; }
.st-busy { position:absolute; right:12px; bottom:12px; color:var(--dim);
  background:rgba(20,22,25,.8); border-radius:8px; padding:6px 10px; }
.st-list { width:100%; gap:1px; }
.st-item { display:flex; align-items:center; width:100%; min-height:28px; padding:0 4px 0 8px;
  border-radius:6px; cursor:pointer; gap:2px; }
.st-item:hover { background:#2b3036; }
.st-item.on { background:#3a312c; color:#ffd9c4; }
.st-item .st-name { flex:1; }
.st-item.off .st-name { color:#6b7178; }
.st-chip { min-height:28px !important; padding:0 10px !important; text-transform:none;
  border-radius:14px !important; background:#2b3036 !important; color:var(--text) !important; }
.st-act { text-transform:none; border-radius:8px !important; }
.q-uploader { background:#191c1f !important; border-color:var(--line) !important; }
.q-uploader__header { background:#2b3036 !important; color:var(--text) !important; }
.q-uploader__list { min-height:8px; padding:4px; }
.st-panel .q-slider { height:22px; }
.st-panel .q-slider__track { background:#3a3f46; }
.st-scale { width:100%; height:8px; border-radius:4px; background:linear-gradient(90deg,
  #c9c4be,#ead9a4,#f3c25e,#ee9140,#dc5a3b,#b22a45,#7d1554); }
.q-table__card, .q-card, .q-dialog .q-card { background:#23272c !important; color:var(--text); }
.q-table tbody td, .q-table th { font-size:12px; padding:3px 8px !important; }
.q-tooltip { font-size:12px; background:#0f1113; }
.rv-root { position:absolute; inset:0; overflow:hidden; }
.rv-canvas { width:100%; height:100%; display:block; touch-action:none; outline:none; }
.rv-labels, .rv-tip { position:absolute; left:0; top:0; pointer-events:none; }
.rv-label { position:absolute; white-space:nowrap; padding:1px 7px; border-radius:9px;
  background:rgba(15,17,19,.75); color:var(--text); }
.rv-label.rv-chosen { background:var(--good); color:#10161a; }
.rv-tip { display:none; white-space:nowrap; padding:3px 8px; border-radius:6px;
  background:rgba(15,17,19,.9); border:1px solid var(--line); }
.rv-lost { display:none; position:absolute; left:50%; top:16px; transform:translateX(-50%);
  padding:8px 14px; border-radius:8px; background:#5a2f28; }
.rv-offline .rv-lost { display:block; }
.rv-pad { position:relative; width:100%; height:96px; border-radius:8px; background:#191c1f;
  border:1px solid var(--line); cursor:crosshair; touch-action:none; }
.rv-cross-x, .rv-cross-y { position:absolute; background:var(--line); }
.rv-cross-x { top:0; bottom:0; width:1px; } .rv-cross-y { left:0; right:0; height:1px; }
.rv-time { width:100%; }
.rv-line { width:100%; height:58px; display:block; border-radius:6px; cursor:ew-resize;
  touch-action:none; outline:none; }
.rv-line:focus-visible { box-shadow:0 0 0 1px var(--accent); }
.rv-deck { display:flex; align-items:center; gap:8px; padding-top:4px; }
.rv-deck .st-number { width:52px; }
.rv-knob { position:absolute; width:14px; height:14px; border-radius:7px; margin:0 0 -7px -7px;
  background:var(--accent); box-shadow:0 0 0 3px rgba(224,138,99,.25); }
"""
