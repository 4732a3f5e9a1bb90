// Synchronises the address bar and the store, so that a copied address shows the same picture.
import { linkOf, openLink } from '../store/link/link_state';
import { formatPermalink, parsePermalink } from '../store/link/permalink';
import type { Context } from './view';

const kWrite_ms = 400;

export function followAddress(context: Context): void {
  const { store, studies } = context;
  const open = () => {
    const link = parsePermalink(location.hash);
    openLink(link, context);
    if (link.study !== null) void studies.openAt(link.study);
    else if (store.state.studyPage.open) studies.close();
  };
  const write = () => {
    const link = linkOf(context);
    if (link === null) return;
    const hash = formatPermalink(link);
    if (hash !== location.hash)
      history.replaceState(null, '', hash === '' ? location.pathname : hash);
  };
  window.addEventListener('hashchange', open);
  if (location.hash !== '') open();
  context.layouts.onKept(write);
  window.setInterval(write, kWrite_ms);
}
