// Opens a page of this folder in Debian's Chromium and waits until it says `done`:
//   node browser.mjs PAGE PICTURE.png FLAG...
// Prints what the page left in `result`, as JSON.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import { chromium } from 'playwright-core';

const [page, picture, ...flags] = process.argv.slice(2);
const types = { '.html': 'text/html', '.js': 'text/javascript' };
const server = http.createServer((request, response) => {
    const file = path.join(process.cwd(), path.normalize(new URL(request.url, 'http://here').pathname));
    fs.readFile(file, (error, data) => {
        response.writeHead(error ? 404 : 200, { 'content-type': types[path.extname(file)] ?? 'application/octet-stream' });
        response.end(error ? '' : data);
    });
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
const browser = await chromium.launch({
    executablePath: '/usr/bin/chromium',
    ignoreDefaultArgs: ['--enable-unsafe-swiftshader', '--disable-gpu'],
    args: ['--no-sandbox', '--no-first-run', '--disable-background-networking', ...flags],
});
try {
    const tab = await browser.newPage({ viewport: { width: 640, height: 480 } });
    const wrong = new Promise((_, reject) => tab.on('pageerror', reject));
    await tab.goto(`http://127.0.0.1:${server.address().port}/${page}`);
    await Promise.race([wrong, tab.waitForFunction('window.done === true', null, { timeout: 150000 })]);
    console.log(JSON.stringify(await tab.evaluate('window.result')));
    await tab.screenshot({ path: picture });
} finally {
    await browser.close();
    server.close();
}
