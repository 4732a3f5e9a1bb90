// The desk of missions with a server that answers as the test says.
import { RestClient } from '../../src/connection/rest_client';
import { MissionDesk } from '../../src/store/missions/mission_desk';
import type { MissionPage } from '../../src/store/missions/mission_page';
import { Store } from '../../src/store/state';
import { FakeTimers } from './fake_socket';
import { kPlan, sampleReport, sampleWorld, sampleWorldEntry } from './missions';
import { sampleRun } from './samples';

interface Asked {
  method: string;
  url: string;
  body: { document?: { name?: string; flight?: { mission?: unknown } } } | null;
  signal: AbortSignal | null;
}
type Answer = [number, unknown];

export const kCourse = {
  format_version: 1,
  name: 'course',
  title: 'The course',
  description: 'what it is',
  world: { builtin: { seed: 1 } },
  flight: { course: {} },
  camera: { rate_hz: 31 },
  estimators: [{ name: 'feature', type: 'feature' }],
};

export class MissionBench {
  readonly asked: Asked[] = [];
  /** What the browser keeps. */
  readonly kept = new Map<string, string>();
  readonly answers: Record<string, (body: unknown) => Answer> = {
    'GET api/worlds': () => [200, { worlds: [sampleWorldEntry()], complete: true }],
    'GET api/worlds/builtin%3A1': () => [200, sampleWorld()],
    'GET api/scenarios/course': () => [200, kCourse],
    'POST api/missions/report': () => [200, sampleReport()],
    'POST api/runs': () => [201, sampleRun({ id: 'r9' })],
  };
  store = new Store();
  /** Runs that were selected. */
  shown: (string | null)[] = [];
  private timers = new FakeTimers();
  /** Answers to these questions wait until the test lets them go. */
  private readonly held = new Map<string, Promise<void>>();

  /** As after the page was loaded. */
  makeDesk(): MissionDesk {
    this.store = new Store();
    this.store.state.scenarios = [
      {
        name: 'course',
        title: 'Course',
        description: '',
        error: null,
        flight: 'course',
        saved: false,
      },
    ];
    this.timers = new FakeTimers();
    this.shown = [];
    const { timers, shown, kept } = this;
    const storage = {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => void kept.set(key, value),
    };
    return new MissionDesk(
      this.store,
      new RestClient('api', (url, init) => this.answer(url, init)),
      { selectRun: (id) => void shown.push(id) },
      storage,
      (callback, delay_ms) => void timers.set(callback, delay_ms),
      () => 'key-12345',
      () => Promise.resolve(),
    );
  }

  get page(): MissionPage {
    return this.store.state.missionPage;
  }

  async settle(): Promise<void> {
    this.timers.fire();
    await new Promise((resolve) => setTimeout(resolve, 0));
  }

  /** Lets the answer to a question wait. @return lets it go */
  hold(question: string): () => void {
    let go = () => {};
    this.held.set(question, new Promise((resolve) => (go = resolve)));
    return go;
  }

  /** A scenario of the server that flies kPlan from the runway. */
  addPattern(): void {
    const flight = {
      mission: { file: 'a.plan', home: 'runway', airspeed_m_s: 20, airframe: 'aerosonde' },
    };
    const pattern = { ...kCourse, title: 'Pattern', flight };
    this.answers['GET api/scenarios/pattern'] = () => [200, pattern];
    this.answers['GET api/scenarios/pattern/plan'] = () => [200, kPlan];
  }

  private async answer(url: string, init: RequestInit | undefined): Promise<Response> {
    const method = init?.method ?? 'GET';
    const body: unknown = typeof init?.body === 'string' ? JSON.parse(init.body) : null;
    this.asked.push({ method, url, body: body as Asked['body'], signal: init?.signal ?? null });
    const question = `${method} ${url.replace(/\?.*$/, '')}`;
    const answer = this.answers[question];
    if (answer === undefined) throw new TypeError('refused');
    const [status, document] = answer(body);
    await this.held.get(question);
    return new Response(status === 204 ? null : JSON.stringify(document), { status });
  }
}
