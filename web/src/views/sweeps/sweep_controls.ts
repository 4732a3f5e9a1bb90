// Controls of the page of sweeps.
import { h } from '../dom';

export function labelled(text: string, control: HTMLElement): HTMLElement {
  return h('label', {}, text, control);
}

export function select(
  id: string,
  options: readonly (readonly [string, string])[],
  chosen: string,
  choose: (value: string) => void,
): HTMLSelectElement {
  const control = h(
    'select',
    { 'data-role': id },
    ...options.map(([value, label]) => h('option', { value, selected: value === chosen }, label)),
  );
  control.addEventListener('change', () => choose(control.value));
  return control;
}
