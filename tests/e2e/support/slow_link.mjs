// A TCP proxy between browser and server: what the server sends passes at a limited rate, over all
// connections together, as on a slow line.
import { createServer, connect } from 'node:net';

const kTick_ms = 10;
/** What the line stores of a connection before the server has to wait [bytes]. */
const kBuffer_bytes = 16 * 1024;

/** @param port of the server */
export async function openSlowLink(port) {
  const ways = new Set();
  let limit_bytes_per_s = Infinity;
  let credit_bytes = 0;
  let passed_bytes = 0;

  /** Sends what the limit allows, in turn for each connection. */
  const pump = () => {
    for (const way of ways) {
      while (way.waiting.length > 0 && credit_bytes > 0) {
        const chunk = way.waiting[0].subarray(0, Math.max(1, Math.floor(Math.min(credit_bytes, 2048))));
        if (chunk.length === way.waiting[0].length) way.waiting.shift();
        else way.waiting[0] = way.waiting[0].subarray(chunk.length);
        way.waiting_bytes -= chunk.length;
        credit_bytes -= chunk.length;
        passed_bytes += chunk.length;
        way.browser.write(chunk);
      }
      if (way.waiting_bytes < kBuffer_bytes) way.server.resume();
      if (way.waiting.length === 0 && way.ended) way.browser.end();
    }
  };
  let pumped_ms = performance.now();
  const timer = setInterval(() => {
    const now_ms = performance.now();
    const most_bytes = Math.max(2048, limit_bytes_per_s * 0.05);
    credit_bytes = Math.min(most_bytes, credit_bytes + (limit_bytes_per_s * (now_ms - pumped_ms)) / 1000);
    pumped_ms = now_ms;
    pump();
  }, kTick_ms);

  const listener = createServer((browser) => {
    const server = connect(port, '127.0.0.1');
    const way = { browser, server, waiting: [], waiting_bytes: 0, ended: false };
    ways.add(way);
    browser.on('data', (chunk) => server.write(chunk));
    server.on('data', (chunk) => {
      way.waiting.push(chunk);
      way.waiting_bytes += chunk.length;
      if (way.waiting_bytes >= kBuffer_bytes) server.pause();
      if (limit_bytes_per_s === Infinity) pump();
    });
    server.on('end', () => {
      way.ended = true;
    });
    browser.on('end', () => server.end());
    const drop = () => {
      ways.delete(way);
      browser.destroy();
      server.destroy();
    };
    for (const socket of [browser, server]) socket.on('error', drop);
    browser.on('close', drop);
  });
  await new Promise((resolve) => listener.listen(0, '127.0.0.1', resolve));
  return {
    port: listener.address().port,
    /** @param bytes_per_s Infinity lifts the limit */
    limit(bytes_per_s) {
      limit_bytes_per_s = bytes_per_s;
      credit_bytes = bytes_per_s === Infinity ? Infinity : 0;
      pump();
    },
    /** What has passed so far to the browser. */
    passed_bytes: () => passed_bytes,
    async close() {
      clearInterval(timer);
      for (const { browser, server } of ways) {
        browser.destroy();
        server.destroy();
      }
      await new Promise((resolve) => listener.close(resolve));
    },
  };
}
