// What a viewer, who may only look, is offered.
//
// A control that starts or changes something on the server, or a part that consists of such controls,
// has the attribute `data-changes`: a viewer does not see it (styles/access.css), so that it can have
// neither mouse nor focus, and guardChanges() makes it do nothing. What only viewers see has the
// attribute `data-viewer-only`.
import type { Access } from '../protocol/messages';
import type { State } from '../store/state';
import { h } from './dom';

const kUsualNote =
  "You may look at everything here; starting and changing need the operator's address.";

/** Stands in place of what a viewer is not offered. */
export function viewerNote(text = kUsualNote): HTMLElement {
  return h('p', { class: 'viewer-note', 'data-viewer-only': true }, text);
}

/** A text that says something else to a viewer. */
export function wordsFor(operator: string, viewer: string): [HTMLElement, HTMLElement] {
  return [
    h('span', { 'data-changes': true }, operator),
    h('span', { 'data-viewer-only': true }, viewer),
  ];
}

/** What the server has served the page as, before it says so in `hello`. */
export function servedAccess(): Access {
  return document.documentElement.dataset['access'] === 'viewer' ? 'viewer' : 'operator';
}

/** Shows and hides the parts of the page. */
export function showAccess(access: Access): void {
  document.documentElement.dataset['access'] = access;
}

/**
 * Clicks of a viewer on what is hidden do nothing: Enter in a field clicks the button of its form, and
 * a page may click a control itself.
 */
export function guardChanges(state: Pick<State, 'mayChange'>): void {
  const guard = (event: MouseEvent) => {
    if (state.mayChange || !(event.target instanceof Element)) return;
    if (event.target.closest('[data-changes]') === null) return;
    event.preventDefault();
    event.stopPropagation();
  };
  document.addEventListener('click', guard, { capture: true });
}
