import 'uplot/dist/uPlot.min.css';
import '../src/styles/base.css';
import '../src/styles/layout.css';
import '../src/styles/panels.css';
import '../src/styles/side.css';
import '../src/styles/timeline.css';
import { startDashboard } from '../src/app';
import { FakeServer } from './fake_server';

const server = new FakeServer();
startDashboard({
  openSocket: () => server.openSocket(),
  fetch: (url, init) => server.fetch(url, init),
});
