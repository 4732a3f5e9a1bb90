// The form of a scenario's section: a row for each value, frames for what belongs together. Controls
// are made again only if the form has other rows, so that typing is not disturbed.
import type { FieldError } from '../../protocol/field_errors';
import type { Json } from '../../protocol/rest_types';
import type {
  FormNode,
  GroupNode,
  ListNode,
  TextNode,
  ValueNode,
  VariantNode,
} from '../../store/scenario/form_nodes';
import { errorsByPath, valueOfInput, valueOfJson } from '../../store/scenario/form_nodes';
import { h, rebuild, setAttribute, setText } from '../dom';

export interface FormActions {
  set: (path: string, value: Json | undefined) => void;
  add: (path: string, fresh: Json) => void;
}

type Control = HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;

/** A row whose value and error follow the scenario. */
interface Row {
  error: HTMLElement;
  hint: HTMLElement | null;
  control: Control | null;
}

export class ScenarioForm {
  readonly root = h('div', { class: 'scenario-form' });
  private rows = new Map<string, Row>();
  /** Of the entries of lists. */
  private headings = new Map<string, HTMLElement>();

  constructor(private readonly actions: FormActions) {}

  show(nodes: readonly FormNode[], errors: readonly FieldError[]): void {
    rebuild(this.root, JSON.stringify(nodes, withoutTexts), () => {
      this.rows = new Map();
      this.headings = new Map();
      const made = nodes.map((node) => this.node(node, 0));
      // Before one of them gets the focus, in which it is left alone.
      this.fill(nodes);
      return made;
    });
    this.fill(nodes);
    const found = errorsByPath([...this.rows.keys()], errors);
    for (const [path, { error, hint, control }] of this.rows) {
      const message = found.get(path) ?? '';
      setText(error, message);
      error.title = message;
      error.hidden = message === '';
      if (hint !== null) hint.hidden = message !== '';
      if (control !== null) setAttribute(control, 'aria-invalid', message === '' ? null : 'true');
    }
  }

  /** Values of the controls, but of the one in which the viewer types. */
  private fill(nodes: readonly FormNode[]): void {
    for (const node of nodes) {
      const control = this.rows.get(node.id)?.control ?? null;
      if (control !== null && control !== document.activeElement) fillControl(control, node);
      if (node.kind === 'list') {
        for (const { path, title, children } of node.entries) {
          const heading = this.headings.get(path);
          if (heading !== undefined) setText(heading, title);
          this.fill(children);
        }
      }
      if (node.kind === 'group' || node.kind === 'variant') this.fill(node.children);
    }
  }

  private node(node: FormNode, depth: number): HTMLElement {
    switch (node.kind) {
      case 'value':
        return this.row(node, valueControl(node, this.actions), node.unit);
      case 'json':
        return this.row(node, jsonControl(node, this.actions));
      case 'group':
        return this.group(node, depth);
      case 'list':
        return this.list(node);
      case 'variant':
        return this.variant(node, depth);
    }
  }

  private row({ path, id, label, hint }: FormNode, control: Control, unit = ''): HTMLElement {
    const note = h('span', { class: 'row-hint', id: `hint-${id}`, title: hint }, hint);
    const error = this.error(id, note, control);
    control.setAttribute('aria-describedby', `hint-${id} error-${id}`);
    const kind = control.tagName === 'TEXTAREA' ? 'form-row tall' : 'form-row';
    return h(
      'div',
      { class: kind, 'data-path': path },
      h('label', { for: control.id }, label),
      control,
      h('span', { class: 'unit' }, unit),
      h('div', { class: 'row-notes' }, note, error),
    );
  }

  private error(id: string, hint: HTMLElement | null, control: Control | null): HTMLElement {
    const error = h('span', {
      class: 'row-error',
      id: `error-${id}`,
      role: 'alert',
      hidden: true,
    });
    this.rows.set(id, { error, hint, control });
    return error;
  }

  private group(node: GroupNode, depth: number): HTMLElement {
    const { path, label, hint, absent, required, fresh, children } = node;
    const note = h('span', { class: 'row-hint', title: hint }, hint);
    const error = this.error(path, note, null);
    const tool = absent
      ? this.tool('Add', `add-${path}`, `Add: ${label}`, () => this.actions.set(path, fresh))
      : this.tool('Remove', `remove-${path}`, `Remove: ${label}`, () =>
          this.actions.set(path, undefined),
        );
    const head = h(
      'div',
      { class: 'form-head' },
      h('h4', {}, label),
      required ? null : tool,
      h('div', { class: 'row-notes' }, note, error),
    );
    return h(
      'section',
      { class: `form-group depth-${Math.min(depth, 2)}`, 'data-path': path, 'aria-label': label },
      head,
      ...children.map((child) => this.node(child, depth + 1)),
    );
  }

  private list(node: ListNode): HTMLElement {
    const { path, label, hint, entries, full, fresh } = node;
    const note = h('span', { class: 'row-hint', title: hint }, hint);
    const add = this.tool('Add', `add-${path}`, `Add to ${label}`, () =>
      this.actions.add(path, fresh),
    );
    add.disabled = full;
    return h(
      'section',
      { class: 'form-group depth-0', 'data-path': path, 'aria-label': label },
      h(
        'div',
        { class: 'form-head' },
        h('h4', {}, label),
        add,
        h('div', { class: 'row-notes' }, note, this.error(path, note, null)),
      ),
      ...entries.map((entry) => {
        const error = this.error(entry.path, null, null);
        const heading = h('h4', {}, entry.title);
        this.headings.set(entry.path, heading);
        return h(
          'section',
          { class: 'form-group depth-1', 'data-path': entry.path, 'aria-label': entry.title },
          h(
            'div',
            { class: 'form-head' },
            heading,
            this.tool('Remove', `remove-${entry.path}`, `Remove: ${entry.title}`, () =>
              this.actions.set(entry.path, undefined),
            ),
            error,
          ),
          ...entry.children.map((child) => this.node(child, 2)),
        );
      }),
    );
  }

  private variant(node: VariantNode, depth: number): HTMLElement {
    const control = h(
      'select',
      { id: `edit-${node.path}` },
      ...(node.required ? [] : [h('option', { value: '' }, 'not given')]),
      ...node.choices.map(({ label }, i) => h('option', { value: String(i) }, label)),
    );
    control.addEventListener('change', () => {
      const choice = node.choices[Number(control.value)];
      this.actions.set(node.path, control.value === '' ? undefined : choice?.fresh);
    });
    return h(
      'div',
      { class: 'form-variant' },
      this.row(node, control),
      ...node.children.map((child) => this.node(child, depth + 1)),
    );
  }

  private tool(text: string, role: string, label: string, run: () => void): HTMLButtonElement {
    return h(
      'button',
      {
        class: 'tab',
        type: 'button',
        id: role,
        'data-role': role,
        'aria-label': label,
        onclick: run,
      },
      text,
    );
  }
}

/** The rows of a form, whatever their values. */
function withoutTexts(name: string, value: unknown): unknown {
  return ['text', 'title', 'fresh', 'usual'].includes(name) ? undefined : value;
}

function fillControl(control: Control, node: FormNode): void {
  if (node.kind === 'variant') control.value = node.chosen < 0 ? '' : String(node.chosen);
  else if (node.kind === 'json') control.value = node.text;
  else if (node.kind !== 'value') return;
  else if (control instanceof HTMLInputElement && control.type === 'checkbox') {
    control.checked = (node.text === '' ? node.usual : node.text) === 'true';
  } else {
    if (control instanceof HTMLSelectElement) offer(control, node.text);
    control.value = node.text;
  }
}

/** A value that is none of the choices is shown all the same. */
function offer(select: HTMLSelectElement, text: string): void {
  if ([...select.options].some(({ value }) => value === text)) return;
  select.append(h('option', { value: text }, text === '' ? 'not given' : text));
}

function valueControl(node: ValueNode, actions: FormActions): Control {
  const { path, input, choices, usual, required } = node;
  const id = `edit-${node.id}`;
  const read = (text: string) => {
    const value = valueOfInput(input, text);
    // A text may be empty where it must be given: the error says so.
    actions.set(path, value === undefined && required && input === 'text' ? '' : value);
  };
  if (input === 'switch') {
    const box = h('input', { id, type: 'checkbox' });
    box.addEventListener('change', () => read(String(box.checked)));
    return box;
  }
  if (input === 'choice') {
    const empty = usual === '' ? 'not given' : `default (${usual})`;
    const select = h(
      'select',
      { id },
      ...(required ? [] : [h('option', { value: '' }, empty)]),
      ...choices.map((value) => h('option', { value }, value)),
    );
    select.addEventListener('change', () => read(select.value));
    return select;
  }
  const field = h('input', {
    id,
    type: 'text',
    inputmode: input === 'number' ? 'decimal' : undefined,
    placeholder: usual,
    autocomplete: 'off',
    spellcheck: 'false',
  });
  field.addEventListener('input', () => read(field.value));
  return field;
}

function jsonControl({ path, id }: TextNode, actions: FormActions): Control {
  const area = h('textarea', { id: `edit-${id}`, rows: 4, spellcheck: 'false' });
  area.addEventListener('input', () => actions.set(path, valueOfJson(area.value)));
  return area;
}
