// Inputs of the page of missions: each shows a value and passes on what is typed.
import { h, setText } from '../dom';

export interface Field {
  readonly root: HTMLElement;
  /** Shows a value, unless it is being typed. */
  show(): void;
}

export interface NumberFieldOptions {
  /** Unique on the page. */
  id: string;
  label: string;
  unit: string;
  hint?: string;
  step?: number;
  min?: number;
  max?: number;
  /** null = nothing is shown. */
  get: () => number | null;
  set: (value: number) => void;
  digits?: number;
}

export function numberField(options: NumberFieldOptions): Field {
  const { id, label, unit, hint = '', step = 1, min, max, get, set, digits = 3 } = options;
  const input = h('input', {
    id,
    type: 'number',
    step: 'any',
    autocomplete: 'off',
    'aria-describedby': `${id}-error`,
  });
  const error = h('div', { class: 'field-error', id: `${id}-error`, hidden: true });
  const complain = (text: string) => {
    setText(error, text);
    error.hidden = text === '';
    input.setAttribute('aria-invalid', text === '' ? 'false' : 'true');
  };
  const take = () => {
    const value = Number(input.value);
    const low = min ?? -Infinity;
    const high = max ?? Infinity;
    if (input.value.trim() === '' || !Number.isFinite(value)) complain('must be a number');
    else if (value < low || value > high) complain(limitText(min, max));
    else {
      complain('');
      set(value);
    }
  };
  input.addEventListener('input', take);
  input.addEventListener('blur', () => {
    complain('');
    show();
  });
  // Steps by the field's own size; the browser's would be 1 without a limit of digits.
  input.addEventListener('keydown', (event) => {
    if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
    event.preventDefault();
    event.stopPropagation();
    const by = (event.key === 'ArrowUp' ? 1 : -1) * step * (event.shiftKey ? 10 : 1);
    const next = (Number(input.value) || 0) + by;
    input.value = textOf(Math.max(min ?? -Infinity, Math.min(max ?? Infinity, next)), digits);
    take();
  });
  const show = () => {
    if (document.activeElement === input) return;
    const value = get();
    input.value = value === null ? '' : textOf(value, digits);
  };
  const root = h(
    'div',
    { class: 'mission-field', title: hint },
    h('label', { for: id }, label),
    input,
    h('span', { class: 'unit' }, unit),
    error,
  );
  return { root, show };
}

export interface ChoiceFieldOptions {
  id: string;
  label: string;
  hint?: string;
  choices: () => readonly { value: string; label: string }[];
  get: () => string;
  set: (value: string) => void;
}

export function choiceField({
  id,
  label,
  hint = '',
  choices,
  get,
  set,
}: ChoiceFieldOptions): Field {
  const select = h('select', { id });
  select.addEventListener('change', () => set(select.value));
  let shown = '';
  const show = () => {
    const value = get();
    const offered = [...choices()];
    if (!offered.some((choice) => choice.value === value)) offered.push({ value, label: value });
    const key = JSON.stringify(offered);
    if (key !== shown) {
      shown = key;
      select.replaceChildren(
        ...offered.map((choice) => h('option', { value: choice.value }, choice.label)),
      );
    }
    select.value = value;
  };
  const root = h(
    'div',
    { class: 'mission-field wide', title: hint },
    h('label', { for: id }, label),
    select,
  );
  return { root, show };
}

function limitText(min: number | undefined, max: number | undefined): string {
  if (min !== undefined && max !== undefined) return `must be in [${min}, ${max}]`;
  return min !== undefined ? `must be at least ${min}` : `must be at most ${max ?? ''}`;
}

/** Without needless zeros. */
function textOf(value: number, digits: number): string {
  return String(Number(value.toFixed(digits)));
}
