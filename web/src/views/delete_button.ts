// A bin that deletes for good what its second click confirms.
import { Confirmation } from '../store/confirmation';
import { h } from './dom';
import { icon } from './icons';

/** @param what  "the log NAME", for people */
export function deleteButton(name: string, what: string, remove: () => void): HTMLElement {
  const button = h('button', { class: 'icon-button', type: 'button', 'data-changes': true });
  const show = (asked: boolean) => {
    button.classList.toggle('danger', asked);
    button.title = asked ? `Click again to delete ${what} for good` : `Delete ${what}`;
    button.ariaLabel = asked ? `Confirm the deletion of ${name}` : `Delete ${name}`;
    button.replaceChildren(asked ? 'Delete?' : icon('bin'));
  };
  const question = new Confirmation(show, (callback, delay_ms) => {
    window.setTimeout(callback, delay_ms);
  });
  button.addEventListener('click', () => {
    if (question.click()) remove();
  });
  show(false);
  return button;
}
