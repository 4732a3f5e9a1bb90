// A socket whose other end is the test.
import type { Socket, Timers } from '../../src/connection/stream_client';
import type { ClientMessage } from '../../src/protocol/messages';

export type Sent = ClientMessage & { request: number };

export class FakeSocket implements Socket {
  binaryType: BinaryType = 'blob';
  onopen: ((event: Event) => void) | null = null;
  onmessage: ((event: MessageEvent) => void) | null = null;
  onclose: ((event: CloseEvent) => void) | null = null;
  readonly sent: Sent[] = [];
  closed = false;

  send(text: string): void {
    this.sent.push(JSON.parse(text) as Sent);
  }

  close(): void {
    this.closed = true;
  }

  /** What the server says: an object as text, a buffer as it is. */
  receive(data: object): void {
    const payload = data instanceof ArrayBuffer ? data : JSON.stringify(data);
    this.onmessage?.({ data: payload } as MessageEvent);
  }

  /** @param access  absent as from an older server */
  hello(protocol = 2, access?: string): void {
    this.receive({ type: 'hello', protocol, server: 'overfly 0.1.0', connection: 'c1', access });
  }

  lose(code = 1006): void {
    this.onclose?.({ code } as CloseEvent);
  }

  types(): string[] {
    return this.sent.map(({ type }) => type);
  }

  last(): Sent {
    const message = this.sent.at(-1);
    if (message === undefined) throw new Error('nothing was sent');
    return message;
  }
}

/** Timers that go off when the test says so. */
export class FakeTimers implements Timers {
  private next = 1;
  readonly waiting = new Map<number, { callback: () => void; delay_ms: number }>();

  set = (callback: () => void, delay_ms: number): number => {
    const id = this.next;
    this.next += 1;
    this.waiting.set(id, { callback, delay_ms });
    return id;
  };

  clear = (id: number): void => {
    this.waiting.delete(id);
  };

  delays(): number[] {
    return [...this.waiting.values()].map(({ delay_ms }) => delay_ms);
  }

  /** Lets all that wait now go off. */
  fire(): void {
    const due = [...this.waiting.values()];
    this.waiting.clear();
    for (const { callback } of due) callback();
  }
}
