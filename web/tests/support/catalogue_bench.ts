// A catalogue of scenarios and runs with a simulated server.
import { RestClient } from '../../src/connection/rest_client';
import { StreamClient } from '../../src/connection/stream_client';
import { Catalogue } from '../../src/store/catalogue';
import { Notices } from '../../src/store/notices';
import { Store } from '../../src/store/state';
import { FakeSocket, FakeTimers } from './fake_socket';
import { unwatchedSession } from './viewing';

export const document = {
  seed: 1,
  pacing: 'lockstep',
  estimators: [],
};
export const kScenario = {
  name: 'course',
  title: 'Course',
  description: '',
  error: null,
  flight: 'course',
  saved: false,
};

/** A catalogue whose server answers by method and path. */
export function catalogue(answers: Record<string, (body: string) => [number, unknown]>) {
  const store = new Store();
  const timers = new FakeTimers();
  const later = (callback: () => void, delay_ms: number) => void timers.set(callback, delay_ms);
  const notices = new Notices(store, later);
  const session = unwatchedSession(store, notices);
  const socket = new FakeSocket();
  const client = new StreamClient({
    open: () => socket,
    timers,
    random: () => 0,
    ask: () => undefined,
    listener: session,
  });
  session.use(client);
  client.connect();
  socket.hello();
  const rest = new RestClient('', (url, init) => {
    const answer = answers[`${init?.method ?? 'GET'} ${url}`];
    if (answer === undefined) return Promise.reject(new TypeError('refused'));
    const [status, body] = answer(typeof init?.body === 'string' ? init.body : '');
    return Promise.resolve(new Response(status === 204 ? null : JSON.stringify(body), { status }));
  });
  const subject = new Catalogue(store, rest, session, notices, later, () => 'key');
  return { store, session, socket, subject, timers };
}

export const reading = {
  'GET /scenarios': (): [number, unknown] => [200, { scenarios: [kScenario] }],
  'GET /scenarios/course': (): [number, unknown] => [200, document],
};
