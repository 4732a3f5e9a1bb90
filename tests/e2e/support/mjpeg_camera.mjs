// A camera that sends JPEG images over HTTP (multipart/x-mixed-replace), as network cameras do.
import { createServer } from 'node:http';

const kBoundary = 'frame';

/** @param rate_hz of the images; show() sets the one that is sent */
export async function startMjpegCamera(rate_hz = 10) {
  let image = null;
  let viewers = 0;
  const server = createServer((request, response) => {
    viewers += 1;
    response.writeHead(200, {
      'Content-Type': `multipart/x-mixed-replace;boundary=${kBoundary}`,
    });
    const timer = setInterval(() => {
      if (image === null) return;
      response.write(`--${kBoundary}\r\nContent-Type: image/jpeg\r\n`);
      response.write(`Content-Length: ${image.length}\r\n\r\n`);
      response.write(image);
      response.write('\r\n');
    }, 1000 / rate_hz);
    response.on('close', () => {
      viewers -= 1;
      clearInterval(timer);
    });
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    address: `http://127.0.0.1:${server.address().port}/video`,
    viewers: () => viewers,
    show: (jpeg) => {
      image = jpeg;
    },
    stop: () => {
      server.closeAllConnections();
      return new Promise((resolve) => server.close(resolve));
    },
  };
}
