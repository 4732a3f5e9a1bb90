// Puts the parts together; where sockets, answers and pictures come from is given.
import type { Fetch } from './connection/rest_client';
import { RestClient } from './connection/rest_client';
import type { Socket } from './connection/stream_client';
import { StreamClient } from './connection/stream_client';
import { Catalogue } from './store/catalogue';
import { Notices } from './store/notices';
import { Player } from './store/player';
import { SceneControl } from './store/scene_control';
import { Session } from './store/session';
import { Store } from './store/state';
import { followAddress } from './views/address_bar';
import { showScreen } from './views/screen';

export interface Outside {
  openSocket: () => Socket;
  fetch: Fetch;
}

export function startDashboard(outside: Outside): void {
  const later = (callback: () => void, delay_ms: number) => window.setTimeout(callback, delay_ms);
  const store = new Store();
  const notices = new Notices(store, later);
  const session = new Session(store, notices, (jpeg) => createImageBitmap(jpeg));
  const client = new StreamClient({
    open: outside.openSocket,
    timers: { set: later, clear: (id) => window.clearTimeout(id) },
    random: Math.random,
    listener: session,
  });
  session.use(client);
  const player = new Player(store, session);
  const scene = new SceneControl(store, client);
  scene.setMode(store.state.sceneMode);
  const rest = new RestClient('api/v1', outside.fetch);
  const catalogue = new Catalogue(store, rest, session, notices, later, newKey);
  const context = { store, session, player, scene, catalogue, notices, client };
  showScreen(context, document.body);
  followAddress(context);
  window.addEventListener('online', () => client.connect());
  client.connect();
  catalogue.start();
}

function newKey(): string {
  return Array.from(crypto.getRandomValues(new Uint32Array(4)), (n) => n.toString(36)).join('-');
}
