// Helpers that create and update DOM elements.
import { focusAgain, focusIn } from './focus';

type Props = Record<string, string | number | boolean | undefined | ((event: never) => void)>;
type Child = Node | string | null;

/**
 * `on...` props add listeners, boolean props set or omit an attribute, the others become
 * attributes.
 */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  props: Props = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (name === 'style') {
      element.style.cssText = String(value);
    } else if (typeof value === 'function') {
      element.addEventListener(name.replace(/^on/, ''), value as EventListener);
    } else if (value === true) {
      element.setAttribute(name, '');
    } else if (value !== false && value !== undefined) {
      element.setAttribute(name, String(value));
    }
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

/** Sets text only if it differs, so that an unchanged screen costs nothing. */
export function setText(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** The same for the part of an element that a selector finds. */
export function setTextOf(element: HTMLElement, selector: string, text: string): void {
  const part = element.querySelector<HTMLElement>(selector);
  if (part !== null) setText(part, text);
}

export function setAttribute(element: HTMLElement, name: string, value: string | null): void {
  if (element.getAttribute(name) === value) return;
  if (value === null) element.removeAttribute(name);
  else element.setAttribute(name, value);
}

/** Replaces the children if `key` differs from the one they were made for; a control keeps the focus. */
export function rebuild(element: HTMLElement, key: string, make: () => Node[]): void {
  if (element.dataset['key'] === key) return;
  element.dataset['key'] = key;
  const focused = focusIn(element);
  element.replaceChildren(...make());
  if (focused !== null) focusAgain(element, focused);
}

/** A text that is shown as a whole or, in a box that is too narrow, not at all (base.css). */
export function wholeLabel(text: string): HTMLElement {
  return h('span', { class: 'whole-label' }, h('span', {}, text));
}

/** Calls `action` at most once per frame, with the latest argument. */
export function perFrame<T>(action: (value: T) => void): (value: T) => void {
  let waiting: { value: T } | null = null;
  return (value) => {
    if (waiting !== null) {
      waiting.value = value;
      return;
    }
    waiting = { value };
    requestAnimationFrame(() => {
      const newest = waiting;
      waiting = null;
      if (newest !== null) action(newest.value);
    });
  };
}

/**
 * Calls `action` without delay, and then at most once per frame, with the latest argument. For commands
 * to the server, whose answer takes long enough.
 */
export function promptlyPerFrame<T>(action: (value: T) => void): (value: T) => void {
  let framePending = false;
  let waiting: { value: T } | null = null;
  const act = (value: T) => {
    framePending = true;
    requestAnimationFrame(() => {
      framePending = false;
      const newest = waiting;
      waiting = null;
      if (newest !== null) act(newest.value);
    });
    action(value);
  };
  return (value) => {
    if (framePending) waiting = { value };
    else act(value);
  };
}
