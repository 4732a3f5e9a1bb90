// State stored in the address bar: the run, and the instant unless the view is live.

export interface Permalink {
  run: string | null;
  t_ns: number | null;
}

/** "#run=ID&t=SECONDS"; unknown parts are ignored. */
export function parsePermalink(hash: string): Permalink {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  const run = fields.get('run');
  const t = fields.get('t');
  const seconds = t === null || t === '' ? NaN : Number(t);
  return {
    run: run === '' ? null : run,
    t_ns: Number.isFinite(seconds) && seconds >= 0 ? Math.round(seconds * 1e9) : null,
  };
}

export function formatPermalink(link: Permalink): string {
  if (link.run === null) return '';
  const fields = new URLSearchParams({ run: link.run });
  if (link.t_ns !== null) fields.set('t', (link.t_ns / 1e9).toFixed(3));
  return `#${fields.toString()}`;
}
