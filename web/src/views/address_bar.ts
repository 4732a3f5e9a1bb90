// Synchronises the address bar and the store, so that a copied address shows the same run and
// instant.
import { formatPermalink, parsePermalink } from '../store/permalink';
import type { Context } from './view';

const kWrite_ms = 400;

export function followAddress(context: Context): void {
  const { store, session } = context;
  const open = () => {
    const { runs, main, t_ns } = parsePermalink(location.hash);
    session.showRuns(runs, main, t_ns);
  };
  window.addEventListener('hashchange', open);
  if (location.hash !== '') open();
  window.setInterval(() => {
    const { watched, runId, clock } = store.state;
    if (runId !== null && clock === null) return;
    const t_ns = clock === null || clock.live ? null : clock.t_ns;
    const hash = formatPermalink({ runs: watched, main: runId, t_ns });
    if (hash !== location.hash)
      history.replaceState(null, '', hash === '' ? location.pathname : hash);
  }, kWrite_ms);
}
