// Synchronises the address bar and the store, so that a copied address shows the same picture.
import { Address } from '../store/link/address';
import { linkOf, openLink } from '../store/link/link_state';
import { formatPermalink, parsePermalink } from '../store/link/permalink';
import type { Context } from './view';

const kWrite_ms = 400;

export function followAddress(context: Context): void {
  const { store, studies } = context;
  const bar = {
    read: () => location.hash,
    replace: (hash: string) =>
      history.replaceState(null, '', hash === '' ? location.pathname : hash),
  };
  const address = new Address(bar, {
    open: (hash) => {
      const link = parsePermalink(hash);
      openLink(link, context);
      if (link.study !== null) void studies.openAt(link.study);
      else if (store.state.studyPage.open) studies.close();
    },
    shown: () => {
      const link = linkOf(context);
      return link === null ? null : formatPermalink(link);
    },
  });
  const update = () => address.update();
  window.addEventListener('hashchange', update);
  update();
  context.layouts.onKept(update);
  window.setInterval(update, kWrite_ms);
}
