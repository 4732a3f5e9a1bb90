// The dashboard in a browser, on the server that it came from.
import 'uplot/dist/uPlot.min.css';
import './styles/base.css';
import './styles/layout.css';
import './styles/panels.css';
import './styles/side.css';
import './styles/timeline.css';
import { startDashboard } from './app';

const streamUrl = new URL('api/v1/stream', location.href);
streamUrl.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';

startDashboard({
  openSocket: () => new WebSocket(streamUrl),
  fetch: (url, init) => fetch(url, init),
});
