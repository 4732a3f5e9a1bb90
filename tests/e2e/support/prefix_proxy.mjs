// A reverse proxy that serves a server under a path of its own, as nginx does in a laboratory.
import { createServer, request } from 'node:http';
import { connect } from 'node:net';

/** @param port of the server @param prefix such as "/overfly" */
export async function openPrefixProxy(port, prefix) {
  const sockets = new Set();
  const inner = (url) => (url.startsWith(`${prefix}/`) ? url.slice(prefix.length) : null);
  const proxy = createServer((asked, answer) => {
    const path = inner(asked.url);
    if (path === null) {
      answer.writeHead(404, { 'content-type': 'text/plain' });
      answer.end('another application');
      return;
    }
    const { method, headers } = asked;
    const passed = request({ host: '127.0.0.1', port, path, method, headers }, (received) => {
      answer.writeHead(received.statusCode, received.headers);
      received.pipe(answer);
    });
    passed.on('error', () => answer.destroy());
    asked.pipe(passed);
  });
  proxy.on('connection', (socket) => {
    sockets.add(socket);
    socket.on('close', () => sockets.delete(socket));
  });
  proxy.on('upgrade', (asked, browser, head) => {
    const path = inner(asked.url);
    if (path === null) {
      browser.destroy();
      return;
    }
    const server = connect(port, '127.0.0.1', () => {
      let text = `${asked.method} ${path} HTTP/1.1\r\n`;
      for (let i = 0; i < asked.rawHeaders.length; i += 2) {
        text += `${asked.rawHeaders[i]}: ${asked.rawHeaders[i + 1]}\r\n`;
      }
      server.write(`${text}\r\n`);
      server.write(head);
      server.pipe(browser);
      browser.pipe(server);
    });
    for (const [one, other] of [
      [browser, server],
      [server, browser],
    ]) {
      one.on('error', () => other.destroy());
      one.on('close', () => other.destroy());
    }
  });
  await new Promise((resolve) => proxy.listen(0, '127.0.0.1', resolve));
  return {
    url: `http://127.0.0.1:${proxy.address().port}${prefix}`,
    async close() {
      for (const socket of sockets) socket.destroy();
      await new Promise((resolve) => proxy.close(resolve));
    },
  };
}
