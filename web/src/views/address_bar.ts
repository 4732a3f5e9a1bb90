// Synchronises the address bar and the store, so that a copied address shows the same run and
// instant.
import { formatPermalink, parsePermalink } from '../store/permalink';
import type { Context } from './view';

const kWrite_ms = 400;

export function followAddress(context: Context): void {
  const { store, session } = context;
  const open = () => {
    const { run, t_ns } = parsePermalink(location.hash);
    session.selectRun(run, t_ns);
  };
  window.addEventListener('hashchange', open);
  if (location.hash !== '') open();
  window.setInterval(() => {
    const { runId, playback } = store.state;
    const t_ns = playback === null || playback.live ? null : playback.t_ns;
    if (runId !== null && playback === null) return;
    const hash = formatPermalink({ run: runId, t_ns });
    if (hash !== location.hash)
      history.replaceState(null, '', hash === '' ? location.pathname : hash);
  }, kWrite_ms);
}
