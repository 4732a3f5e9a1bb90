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
  addEventListener(): void {
    // Nothing happens here.
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
