#include "conformance/report/html.h"

namespace vernier::conformance {

const char* const kReportStyle = R"(
:root {
    color-scheme: light dark;
    --ground: #f6f5f1; --card: #ffffff; --ink: #1d2430; --soft: #667084; --line: #e2dfd6;
    --accent: #b5502b; --good: #2f7d5b; --goodground: #e2f1e9; --bad: #b3263e; --badground: #fbe4e6;
    --code: #f2f0ea;
}
@media (prefers-color-scheme: dark) {
    :root {
        --ground: #12151b; --card: #1a1f28; --ink: #e6e8ee; --soft: #98a2b6; --line: #2a313d;
        --accent: #f0945f; --good: #7fd1a8; --goodground: #17352a; --bad: #ff8f9c; --badground: #43181f;
        --code: #141922;
    }
}
* { box-sizing: border-box; }
body {
    margin: 0; background: var(--ground); color: var(--ink);
    font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; font-variant-numeric: tabular-nums;
}
main { max-width: 1500px; margin: 0 auto; padding: 0 28px 80px; }
header.top { padding: 44px 0 20px; border-bottom: 1px solid var(--line); margin-bottom: 26px; }
header.top p { max-width: 76ch; color: var(--soft); margin: 6px 0 0; }
h1 { font-size: 34px; line-height: 1.15; margin: 0; letter-spacing: -0.02em; font-weight: 680; }
h1 small { font-size: 16px; color: var(--soft); font-weight: 400; letter-spacing: 0; margin-left: 10px; }
h2 { font-size: 21px; margin: 44px 0 12px; letter-spacing: -0.01em; }
h3 { font-size: 14px; margin: 0 0 8px; }
a { color: inherit; text-decoration-color: var(--accent); text-underline-offset: 3px; }
a:hover { color: var(--accent); }
/* Vernier marks: a main scale and a slightly finer one below it. */
.marks { height: 22px; margin: 0 0 18px; opacity: .85;
    background: repeating-linear-gradient(90deg, var(--ink) 0 1px, transparent 1px 20px) 0 0 / 100% 10px no-repeat,
                repeating-linear-gradient(90deg, var(--accent) 0 1px, transparent 1px 19px) 0 12px / 100% 10px no-repeat; }
.tiles { display: flex; flex-wrap: wrap; gap: 14px; margin: 20px 0; }
.tile { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 12px 18px; min-width: 130px; }
.tile b { display: block; font-size: 26px; line-height: 1.2; font-weight: 650; }
.tile.bad b { color: var(--bad); } .tile.good b { color: var(--good); }
.tile span { color: var(--soft); font-size: 13px; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); gap: 14px; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 16px 18px; overflow-wrap: anywhere; }
.card h3 { font-size: 16px; } .card .absent { color: var(--soft); }
.card pre { margin: 8px 0 0; font-size: 12px; color: var(--soft); white-space: pre-wrap; background: none; padding: 0; border: 0; }
table { border-collapse: collapse; }
.facts td { padding: 2px 18px 2px 0; vertical-align: top; } .facts td:first-child { color: var(--soft); white-space: nowrap; }
.legend { display: grid; grid-template-columns: repeat(auto-fit, minmax(420px, 1fr)); gap: 26px; background: var(--card);
    border: 1px solid var(--line); border-radius: 10px; padding: 16px 18px; font-size: 13px; }
.legend p { color: var(--soft); margin: 8px 0 0; }
.swatches { list-style: none; margin: 0; padding: 0; } .swatches li { margin: 2px 0; }
.swatches i { display: inline-block; width: 12px; height: 12px; border-radius: 3px; margin-right: 8px; vertical-align: -1px; }
.scale { display: flex; } .scale span { flex: 1; font-size: 10px; text-align: center; color: var(--soft); white-space: nowrap; }
.scale i { display: block; height: 18px; margin-bottom: 3px; }
.scene { background: var(--card); border: 1px solid var(--line); border-radius: 12px; margin: 16px 0; padding: 16px 18px 14px; }
.scene.failed { border-left: 4px solid var(--bad); }
.scene .head { display: flex; align-items: baseline; gap: 12px; flex-wrap: wrap; }
.scene .head a { font-size: 17px; font-weight: 640; text-decoration: none; }
.scene .head p { margin: 0; color: var(--soft); flex: 1 1 420px; font-size: 13.5px; }
.strip { display: grid; grid-template-columns: repeat(6, minmax(0, 1fr)); gap: 12px; margin: 12px 0 10px; }
figure { margin: 0; min-width: 0; } figcaption { font-size: 12.5px; margin-top: 5px; line-height: 1.35; }
figcaption b { font-weight: 600; } figcaption span { color: var(--soft); }
.strip img, .missing { width: 100%; height: auto; aspect-ratio: 1; object-fit: contain; border-radius: 6px; display: block;
    background: var(--code); border: 1px solid var(--line); }
.missing { display: flex; align-items: center; justify-content: center; text-align: center; padding: 10px; margin: 0;
    color: var(--soft); font-size: 12px; border-style: dashed; overflow: hidden; overflow-wrap: anywhere; }
.missing.bad { color: var(--bad); }
.note { font-size: 12.5px; margin: 8px 0 0; color: var(--accent); }
.compare { display: grid; grid-template-columns: 190px 1fr 190px 1fr; gap: 4px 16px; font-size: 12.5px; align-items: start; }
.compare > div:nth-child(odd) { color: var(--soft); }
.bar { display: flex; height: 11px; border-radius: 6px; overflow: hidden; background: var(--line); margin-top: 4px; }
.bar i { min-width: 4px; }
.counts span { margin-right: 12px; white-space: nowrap; color: var(--soft); } .counts b { color: var(--ink); font-weight: 600; }
.counts .bad, .counts .bad b { color: var(--bad); }
.pill { border-radius: 99px; padding: 1px 11px; font-size: 12.5px; font-weight: 600; white-space: nowrap; }
.pill { color: var(--soft); background: var(--code); } .pill.good { color: var(--good); background: var(--goodground); } .pill.bad { color: var(--bad); background: var(--badground); }
.viewer { display: inline-block; vertical-align: top; margin: 0 22px 18px 0; max-width: 100%; }
.viewer .buttons { display: flex; flex-wrap: wrap; gap: 6px; margin-bottom: 8px; }
.viewer button { font: inherit; font-size: 13px; border: 1px solid var(--line); background: var(--card); color: var(--ink);
    border-radius: 7px; padding: 3px 11px; cursor: pointer; }
.viewer button[aria-pressed=true] { background: var(--accent); border-color: var(--accent); color: #fff; }
.viewer img { display: none; image-rendering: pixelated; border: 1px solid var(--line); border-radius: 6px; max-width: 100%; height: auto; }
.viewer img.shown { display: block; }
.pixelated { image-rendering: pixelated; border: 1px solid var(--line); border-radius: 6px; display: block; max-width: 100%; height: auto; }
.row { display: flex; flex-wrap: wrap; gap: 18px; margin: 10px 0 16px; align-items: flex-start; }
table.values, table.times { font-size: 13px; background: var(--card); border: 1px solid var(--line); }
.values td, .values th, .times td, .times th { padding: 4px 12px; border: 1px solid var(--line); text-align: right; }
.values th, .times th { font-weight: 600; color: var(--soft); } .values td:first-child, .times td:first-child { text-align: left; }
pre { background: var(--code); border: 1px solid var(--line); border-radius: 8px; padding: 12px 16px; overflow: auto;
    font: 12.5px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; }
details { margin: 8px 0; } summary { cursor: pointer; color: var(--soft); }
ul.plain { margin: 6px 0; padding-left: 20px; } ul.bad li { color: var(--bad); }
@media (max-width: 900px) { .strip { grid-template-columns: repeat(3, minmax(0, 1fr)); } main { padding: 0 14px 60px; }
    .compare { grid-template-columns: 150px 1fr; } }
)";

const char* const kReportScript = R"(
for (const viewer of document.querySelectorAll('.viewer')) {
    const buttons = [...viewer.querySelectorAll('button')], images = [...viewer.querySelectorAll('img')];
    const show = (index) => {
        images.forEach((image, i) => image.classList.toggle('shown', i === index));
        buttons.forEach((button, i) => button.setAttribute('aria-pressed', i === index));
    };
    buttons.forEach((button, i) => button.addEventListener('click', () => show(i)));
    viewer.show = (index) => { if (index < images.length) show(index); };
    show(0);
}
document.addEventListener('keydown', (event) => {
    const index = '123456789'.indexOf(event.key);
    if (index >= 0) document.querySelectorAll('.viewer').forEach((viewer) => viewer.show(index));
});
)";

}  // namespace vernier::conformance
