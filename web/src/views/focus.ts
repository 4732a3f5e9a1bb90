// Keeps the keyboard's focus when controls are made again: the successor of the control gets it.
// What tells a control from others: its id, else its data attributes, else its label, else its
// text; and the data attributes of what it is in. `data-of` is for those that nothing else tells apart.

/** Data attributes that say how something is, not which one it is. */
const kStates = new Set(['key', 'state', 'status', 'kind', 'level', 'attention', 'number']);

type TextField = HTMLInputElement | HTMLTextAreaElement;

export interface Focused {
  tag: string;
  name: string;
  /** Selected text, or place of the caret; null in other controls. */
  selection: { from: number; to: number; all: boolean } | null;
}

/** The control in `root` that has the focus; null if there is none, or if nothing names it. */
export function focusIn(root: HTMLElement): Focused | null {
  const control = document.activeElement;
  if (!(control instanceof HTMLElement) || control === root || !root.contains(control)) return null;
  const name = nameOf(control, root);
  return name === null ? null : { tag: control.tagName, name, selection: selectionOf(control) };
}

/** Focuses the one control that has this name, if the focus was lost. */
export function focusAgain(root: HTMLElement, { tag, name, selection }: Focused): void {
  if (document.activeElement !== null && document.activeElement !== document.body) return;
  const alike = [...root.querySelectorAll<HTMLElement>(tag)].filter(
    (one) => nameOf(one, root) === name,
  );
  const [control] = alike;
  // Another control must not get it.
  if (control === undefined || alike.length > 1) return;
  control.focus({ preventScroll: true });
  if (selection === null || !isTextField(control)) return;
  if (selection.all) control.select();
  else control.setSelectionRange(selection.from, selection.to);
}

function nameOf(control: HTMLElement, root: HTMLElement): string | null {
  if (control.id !== '') return control.id;
  const text = control.matches('button, a') ? control.textContent : null;
  const own = dataOf(control) || control.getAttribute('aria-label') || text;
  if (own === null || own === '') return null;
  const names = [own];
  for (let place = control.parentElement; place !== null; place = place.parentElement) {
    if (place === root) break;
    names.push(dataOf(place));
  }
  return names.join('\n');
}

/** The data attributes that do not change with its state. */
function dataOf(element: HTMLElement): string {
  const data = Object.entries(element.dataset).filter(([name]) => !kStates.has(name));
  return data.map(([name, value]) => `${name}=${value ?? ''}`).join(' ');
}

function selectionOf(control: HTMLElement): Focused['selection'] {
  if (!isTextField(control)) return null;
  const { selectionStart: from, selectionEnd: to, value } = control;
  if (from === null || to === null) return null;
  return { from, to, all: from === 0 && to === value.length };
}

function isTextField(control: HTMLElement): control is TextField {
  return control instanceof HTMLInputElement || control instanceof HTMLTextAreaElement;
}
