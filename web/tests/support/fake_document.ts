// As much of a document as a panel needs to show texts.
import { vi } from 'vitest';

export class FakeElement {
  children: (FakeElement | string)[] = [];
  hidden = false;
  scrollTop = 0;
  readonly style = {};
  readonly dataset: Record<string, string> = {};
  readonly classList = { toggle: () => undefined, add: () => undefined };
  readonly attributes = new Map<string, string>();
  private readonly listeners = new Map<string, (event: unknown) => void>();

  constructor(readonly tag: string) {}

  get textContent(): string {
    return this.children
      .map((child) => (typeof child === 'string' ? child : child.textContent))
      .join('');
  }
  set textContent(text: string) {
    this.children = [text];
  }
  append(...children: (FakeElement | string)[]): void {
    this.children.push(...children);
  }
  replaceChildren(...children: (FakeElement | string)[]): void {
    this.children = children;
  }
  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }
  getAttribute(name: string): string | null {
    return this.attributes.get(name) ?? null;
  }
  contains(): boolean {
    return false;
  }
  addEventListener(type: string, listener: (event: unknown) => void): void {
    this.listeners.set(type, listener);
  }
  click(): void {
    this.listeners.get('click')?.({});
  }
  /** All elements within it. */
  get within(): FakeElement[] {
    return this.children.flatMap((child) =>
      typeof child === 'string' ? [] : [child, ...child.within],
    );
  }
  /** The element within it that has this role. */
  byRole(role: string): FakeElement {
    const found = this.within.find(({ attributes }) => attributes.get('data-role') === role);
    if (found === undefined) throw new Error(`no element is a ${role}`);
    return found;
  }
  /** Texts of all elements of a tag. */
  textsOf(tag: string): string[] {
    return this.children.flatMap((child) => {
      if (typeof child === 'string') return [];
      return child.tag === tag ? [child.textContent] : child.textsOf(tag);
    });
  }
}

/** Until vi.unstubAllGlobals(). */
export function stubDocument(): void {
  vi.stubGlobal('document', {
    activeElement: null,
    createElement: (tag: string) => new FakeElement(tag),
    createElementNS: (_space: string, tag: string) => new FakeElement(tag),
  });
  vi.stubGlobal('HTMLElement', FakeElement);
  const observer = class {
    observe(): void {
      // Nothing changes by itself.
    }
  };
  for (const kind of ['Resize', 'Mutation']) vi.stubGlobal(`${kind}Observer`, observer);
}
