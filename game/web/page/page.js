// The page around the terminal. textual-serve's script makes the terminal and speaks to what it
// takes for a websocket: `Line`, which keeps a real one and finds the program again when it breaks.
"use strict";

const LEAST_LETTERS = 9, MOST_LETTERS = 60; // px
const ASK_MS = 3000, SILENT_MS = 9000, AGAIN_MS = 1000, LOST_MS = 60000;
const PIECE = 1000; // of a long paste, in characters
const SIGNS = "\u25e2\u2190\u2713";
const ENDED = 4000, ELSEWHERE = 4001, FULL = 4002, IDLE = 4003;

if (document.body.dataset.told) begin(JSON.parse(document.body.dataset.told));

function begin(told) {
  const words = told.words;
  const place = document.getElementById("terminal");
  const notice = document.getElementById("notice");
  const [heading, text, button] = ["h1", ".text", "button"].map((it) => notice.querySelector(it));
  const RealWebSocket = window.WebSocket;
  let socket = null; // the real one
  let line = null; // what the terminal speaks to
  let asked = 0; // since when the server owes an answer; 0 while it does not
  let broken = 0; // since when there is no connection; 0 while there is one
  let running = false; // leaving would interrupt the program
  let ending = null;
  let small = false;
  let letters = 0;
  let whole = true; // the terminal's cells have whole pixels: so where it draws on a canvas
  let makeTerminal = null;

  // --- notices ----------------------------------------------------------------------------------

  function tell(page, act, options = {}) {
    heading.textContent = page.title;
    const [before, after] = page.body.trim().split("{code}");
    text.replaceChildren(before);
    if (after !== undefined) {
      const code = document.createElement("code");
      code.textContent = options.code;
      text.append(code, after);
    }
    button.hidden = !page.button || !act;
    button.textContent = page.button;
    button.onclick = act;
    notice.className = options.below ? "below" : "";
    notice.hidden = false;
    (button.hidden ? document.activeElement : button)?.[button.hidden ? "blur" : "focus"]?.();
  }

  function untell() {
    notice.hidden = true;
    focus();
  }

  function focus() {
    if (notice.hidden) place.querySelector("textarea")?.focus();
  }

  const reload = () => { running = false; location.reload(); };

  // --- the line ---------------------------------------------------------------------------------

  function tab() {
    let name = sessionStorage.getItem("tab");
    if (!name) {
      name = Array.from(crypto.getRandomValues(new Uint8Array(12)), (it) => it.toString(36)).join("");
      name = name.slice(0, 20).padEnd(8, "0");
      sessionStorage.setItem("tab", name);
    }
    return name;
  }

  function connect() {
    const address = new URL("line", document.baseURI);
    address.protocol = address.protocol.replace("http", "ws");
    address.search = new URLSearchParams({ ticket: told.ticket, tab: tab() });
    const mine = (socket = new RealWebSocket(address));
    mine.binaryType = "arraybuffer";
    asked = performance.now();
    mine.onopen = () => { if (mine === socket) asked = 0; };
    mine.onmessage = (event) => {
      if (mine !== socket) return;
      asked = 0;
      if (event.data instanceof ArrayBuffer) {
        running = true;
        if (broken) {
          broken = 0;
          small ? cover() : untell();
        }
        line.dispatchEvent(new MessageEvent("message", { data: event.data }));
      } else if (event.data !== "!") {
        ending = JSON.parse(event.data);
      }
    };
    mine.onclose = (event) => { if (mine === socket) closed(event.code); };
  }

  function say(message) {
    const open = socket?.readyState === RealWebSocket.OPEN;
    if (open) socket.send(message);
    return open;
  }

  function closed(code) {
    socket = null;
    running = false;
    if (code === ENDED && ending) ended();
    else if (code === ELSEWHERE) tell(words.elsewhere, reload);
    else if (code === FULL) tell(words.full, reload);
    else if (code === IDLE) tell(words.idle, reload);
    else {
      broken = broken || performance.now();
      if (performance.now() - broken > LOST_MS) tell(words.lost, reload);
      else {
        tell(words.interrupted);
        setTimeout(connect, AGAIN_MS);
      }
    }
  }

  function ended() {
    const { status, code, url } = ending;
    const leave = () => location.assign(url);
    if (status !== 0) tell(words.failed, reload, { below: true });
    else if (!code) tell(words.ended, reload);
    else {
      tell(words.finished, url ? leave : null, { code });
      if (url) setTimeout(leave, 1500);
    }
  }

  setInterval(() => {
    if (!socket) return;
    if (asked && performance.now() - asked > SILENT_MS) {
      const dead = socket;
      socket = null;
      dead.close();
      closed(0);
    } else if (say("?")) asked = asked || performance.now();
  }, ASK_MS);

  window.WebSocket = class Line extends EventTarget {
    constructor(address) {
      super();
      line = this;
      const has = new URL(address, document.baseURI).searchParams;
      if (whole && has.get("width") < told.columns) { // it has no canvas, and so wider cells
        whole = false;
        letters = 0;
        setTimeout(fit);
        return;
      }
      if (socket) say("r");
      else connect();
      setTimeout(() => this.dispatchEvent(new Event("open")));
    }

    send(message) {
      const [kind, keys] = JSON.parse(message);
      if (kind !== "stdin" || line !== this || !notice.hidden) return;
      for (let at = 0; at < keys.length; at += PIECE) say("k" + keys.slice(at, at + PIECE));
    }

    close() {}
  };

  // --- letters as large as the window allows ----------------------------------------------------

  function cell(size) {
    const context = cell.context || (cell.context = new OffscreenCanvas(100, 100).getContext("2d"));
    context.font = `${size}px "Roboto Mono"`;
    const { width, fontBoundingBoxAscent: up, fontBoundingBoxDescent: down } = context.measureText("W");
    const dots = window.devicePixelRatio;
    const wide = whole ? Math.floor(width * dots) / dots : width + 1 / told.columns;
    return [wide, Math.ceil((up + down) * dots) / dots];
  }

  function largest() {
    for (let size = MOST_LETTERS; size >= LEAST_LETTERS; size -= 0.5) {
      const [width, height] = cell(size);
      if (told.columns * width <= innerWidth && told.rows * height <= innerHeight) return size;
    }
    return 0;
  }

  function cover() {
    say("c");
    tell(words.too_small);
  }

  function fit() {
    const size = largest();
    small = size === 0;
    if (small) {
      if (line === null || socket) cover(); // otherwise the notice that is there matters more
      return;
    }
    if (size !== letters) {
      letters = size;
      const [width, height] = cell(size);
      place.style.width = `${told.columns * width + 0.1}px`;
      place.style.height = `${told.rows * height + 0.1}px`;
      place.className = "textual-terminal";
      place.dataset.fontSize = size;
      place.dataset.sessionWebsocketUrl = "line";
      place.replaceChildren();
      makeTerminal(new Event("load"));
      window.onresize = null;
    } else if (line) say("r");
    if (!broken && (line === null || socket)) untell();
  }

  // --- the browser's own ways -------------------------------------------------------------------

  let resizing = 0;
  addEventListener("resize", () => { clearTimeout(resizing); resizing = setTimeout(fit, 300); });
  addEventListener("wheel", (event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
  }, { capture: true, passive: false });
  for (const it of ["click", "focus", "visibilitychange"]) addEventListener(it, () => setTimeout(focus));
  addEventListener("beforeunload", (event) => { if (running) event.preventDefault(); });

  async function open() {
    await Promise.allSettled(["W", SIGNS].map((it) => document.fonts.load('16px "Roboto Mono"', it)));
    await new Promise((done) => {
      const script = document.createElement("script");
      script.src = "static/textual.js";
      script.onload = done;
      document.head.append(script);
    });
    makeTerminal = window.onload;
    window.onload = null;
    fit();
  }
  open();
}
