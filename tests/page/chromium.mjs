// A headless Chromium by its debugging pipe: JSON messages that end with a zero byte on descriptors 3 and 4. No package
// is needed for that.

import {spawn} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

export class Chromium {
  constructor(program) {
    this.profile = mkdtempSync(join(tmpdir(), 'mimik-page-'));
    this.process = spawn(program, ['--headless=new', '--no-sandbox', '--remote-debugging-pipe', '--disable-gpu-sandbox', '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader', '--disable-background-networking', '--no-first-run', '--hide-scrollbars', `--user-data-dir=${this.profile}`, 'about:blank'],
    {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    this.waiting = new Map();
    this.listeners = [];
    this.next = 0;
    let rest = Buffer.alloc(0);
    this.process.stdio[4].on('data', chunk => {
      rest = Buffer.concat([rest, chunk]);
      for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
        this.take(JSON.parse(rest.subarray(0, end).toString()));
        rest = rest.subarray(end + 1);
      }
    });
    this.process.on('exit', () => {
      for (const {reject} of this.waiting.values()) reject(new Error('Chromium ended'));
      this.waiting.clear();
    });
  }
  take(message) {
    const asked = this.waiting.get(message.id);
    if (!asked) return this.listeners.forEach(listen => listen(message));
    this.waiting.delete(message.id);
    if (message.error) asked.reject(new Error(`${asked.method}: ${message.error.message}`));
    else asked.resolve(message.result);
  }
  send(method, params = {}, sessionId = undefined) {
    const id = ++this.next;
    this.process.stdio[3].write(`${JSON.stringify({id, method, params, sessionId})}\0`);
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject, method}));
  }
  async page() {
    const {targetId} = await this.send('Target.createTarget', {url: 'about:blank'});
    const {sessionId} = await this.send('Target.attachToTarget', {targetId, flatten: true});
    return new Page(this, sessionId);
  }
  async close() {
    const ended = new Promise(resolve => this.process.once('exit', resolve));
    this.send('Browser.close').catch(() => {});
    await ended;
    rmSync(this.profile, {recursive: true, force: true, maxRetries: 5});
  }
}

export class Page {
  constructor(browser, session) {
    Object.assign(this, {browser, session, faults: [], requests: []});
    browser.listeners.push(({method, params, sessionId}) => {
      if (sessionId !== session) return;
      if (method === 'Runtime.exceptionThrown') this.faults.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
      if (method === 'Runtime.consoleAPICalled' && ['error', 'warning', 'assert'].includes(params.type)) this.faults.push(params.args.map(a => a.value ?? a.description).join(' '));
      // What the browser says of its own software renderer is no fault of the page.
      if (method === 'Log.entryAdded' && ['error', 'warning'].includes(params.entry.level) && !/GPU stall|software WebGL|SwiftShader/i.test(params.entry.text)) this.faults.push(params.entry.text);
      if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
    });
  }
  send(method, params) { return this.browser.send(method, params, this.session); }
  async open(url, {width, height, dark = false}) {
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await this.send(`${domain}.enable`);
    await this.send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: 1, mobile: false});
    await this.send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'}]});
    await this.send('Page.navigate', {url});
  }
  async value(expression) {
    const {result, exceptionDetails} = await this.send('Runtime.evaluate', {expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }
  /** Waits until the expression is true. */
  async until(expression, seconds = 60) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await new Promise(resolve => setTimeout(resolve, 50)))
      if (await this.value(expression)) return;
    throw new Error(`not within ${seconds} s: ${expression}; faults: ${this.faults.join('; ') || 'none'}`);
  }
  async key(key) {
    for (const type of ['keyDown', 'keyUp']) await this.send('Input.dispatchKeyEvent', {type, key, code: key, windowsVirtualKeyCode: {ArrowRight: 39, ArrowLeft: 37, Tab: 9, Enter: 13, Home: 36, End: 35}[key], ...(key === 'Enter' && type === 'keyDown' ? {text: '\r'} : {})});
  }
  async picture(whole = false) {
    const {data} = await this.send('Page.captureScreenshot', {format: 'png', captureBeyondViewport: whole});
    return Buffer.from(data, 'base64');
  }
}
