// The dashboard's entry point; it connects to the server that served it.
import 'dockview-core/dist/styles/dockview.css';
import 'uplot/dist/uPlot.min.css';
import './styles/themes.css';
import './styles/base.css';
import './styles/access.css';
import './styles/layout.css';
import './styles/dock.css';
import './styles/panels.css';
import './styles/pictures.css';
import './styles/scene.css';
import './styles/errors.css';
import './styles/plots.css';
import './styles/plot3d.css';
import './styles/side.css';
import './styles/runs.css';
import './styles/scenario.css';
import './styles/timeline.css';
import './styles/estimators.css';
import './styles/logs.css';
import './styles/residuals.css';
import './styles/scoring.css';
import './styles/calibration.css';
import './styles/calibration_images.css';
import './styles/missions.css';
import './styles/mission_map.css';
import './styles/sweeps.css';
import './styles/studies.css';
import './styles/palette.css';
import './styles/narrow.css';
import { CalibrationClient } from './connection/calibration_client';
import { RestClient } from './connection/rest_client';
import { StreamClient } from './connection/stream_client';
import { StudyClient } from './connection/study_client';
import { SweepClient } from './connection/sweep_client';
import { uploadByBrowser } from './connection/upload';
import { Alignment } from './store/alignment';
import { CalibrationDesk } from './store/calibration/calibration_desk';
import { Cameras } from './store/pictures/cameras';
import { openVideo, videoWorks } from './store/pictures/video_decoding';
import { PixelProbe } from './store/pictures/pixel_probe';
import { PlotTime } from './store/plots/plot_time';
import { Catalogue } from './store/catalogue';
import { LayoutExchange } from './store/layouts/layout_exchange';
import { Layouts } from './store/layouts/layouts';
import type { Storage } from './store/layouts/layouts';
import { LogBrowser } from './store/logs/log_browser';
import { LogSmoothing } from './store/logs/log_smoothing';
import { LogWorlds } from './store/logs/log_worlds';
import { MissionDesk } from './store/missions/mission_desk';
import { Notices } from './store/notices';
import { parsePermalink } from './store/link/permalink';
import { Player } from './store/playback/player';
import { ScenarioDesk } from './store/scenario/scenario_desk';
import { lookFrom, showText, viewText } from './store/scene/scene_look';
import { SceneControl } from './store/scene/scene_control';
import { ReportMaker } from './store/runs/report_maker';
import { ScoreDesk } from './store/scoring/score_desk';
import { Sensors } from './store/sensors/sensors';
import { Session } from './store/session';
import { Store } from './store/state';
import { StudyDesk } from './store/studies/study_desk';
import { SweepDesk } from './store/sweeps/sweep_desk';
import { TabStorage } from './store/tab_storage';
import { Themes } from './store/themes';
import { TrackColours } from './store/track_colours';
import { VehicleConnect } from './store/vehicle/vehicle_connect';
import { servedAccess } from './views/access';
import { followAddress } from './views/address_bar';
import { applyTheme } from './views/paint';
import { showScreen } from './views/screen';

const streamUrl = new URL('api/v1/stream', location.href);
streamUrl.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';

const later = (callback: () => void, delay_ms: number) => window.setTimeout(callback, delay_ms);
const newKey = () =>
  Array.from(crypto.getRandomValues(new Uint32Array(4)), (n) => n.toString(36)).join('-');

const store = new Store(servedAccess());
const notices = new Notices(store, later);
const session = new Session(
  store,
  notices,
  (jpeg) => createImageBitmap(jpeg),
  openVideo,
  () => performance.now(),
);
void videoWorks().then((works) => session.useVideo(works));
const rest: RestClient = new RestClient(
  'api/v1',
  (url, init) => fetch(url, init),
  () => client.lock(),
);
const client: StreamClient = new StreamClient({
  open: () => new WebSocket(streamUrl),
  timers: { set: later, clear: (id) => window.clearTimeout(id) },
  random: Math.random,
  ask: () => {
    void rest.streamRefusal().then((refusal) => {
      if (refusal !== null && refusal.status !== 0) client.refused(refusal.message);
    });
  },
  listener: session,
});
session.use(client);
const player = new Player(store, session);
const scene = new SceneControl(store, client);
const catalogue = new Catalogue(store, rest, session, notices, later, newKey);
const scenarios = new ScenarioDesk(store, rest, catalogue, notices, later);

const alignment = new Alignment(store, rest, session, notices);
const cameras = new Cameras(store, rest, later);
const probe = new PixelProbe(store, rest, later);
const reports = new ReportMaker(store, rest, notices);
const sensors = new Sensors(store, rest, { now_ms: () => performance.now(), later });
const logs = new LogBrowser(store, rest, session, uploadByBrowser, newKey);
const connect = new VehicleConnect(store, rest, session, newKey);
const scores = new ScoreDesk(store, rest, uploadByBrowser);
const calibration = new CalibrationDesk(
  store,
  new CalibrationClient(rest),
  rest,
  scenarios,
  notices,
  later,
);
const worlds = new LogWorlds(store, rest);
const storage = browserStorage(() => window.localStorage);
const drafts = new TabStorage(
  browserStorage(() => window.sessionStorage),
  storage,
);
const missions = new MissionDesk(store, rest, session, drafts, later, newKey, () =>
  catalogue.readScenarios(),
);
const sweeps = new SweepDesk(store, new SweepClient(rest), session, notices, later);
const studies = new StudyDesk(store, new StudyClient(rest), rest, session, notices, later);
const layouts = new Layouts(store, notices, storage, {
  look: () => {
    const { scene: shown, sideBySide } = store.state;
    return { view: viewText(shown), show: showText(shown), sideBySide };
  },
  apply: ({ view, show, sideBySide }) => {
    scene.apply(lookFrom(view, show));
    session.setSideBySide(sideBySide);
  },
});
const layoutExchange = new LayoutExchange(layouts, notices);
const themes = new Themes(store, storage, applyTheme);
const colours = new TrackColours(store, storage);
const smoothing = new LogSmoothing(store, rest, later, newKey);

const context = {
  store,
  session,
  player,
  scene,
  catalogue,
  scenarios,
  alignment,
  cameras,
  probe,
  plotTime: new PlotTime(store),
  sensors,
  logs,
  smoothing,
  worlds,
  connect,
  scores,
  calibration,
  missions,
  sweeps,
  studies,
  reports,
  rest,
  notices,
  client,
  layouts,
  layoutExchange,
  themes,
  colours,
};
scene.apply(store.state.scene);
layouts.applyLook();
showScreen(context, document.body);
followAddress(context);
window
  .matchMedia('(prefers-color-scheme: light)')
  .addEventListener('change', () => themes.refresh());
document.addEventListener('visibilitychange', () => {
  const shown = document.visibilityState === 'visible';
  session.showPage(shown);
  // Another tab may have saved one.
  if (shown) void catalogue.readScenarios();
});
window.addEventListener('online', () => client.connect());
client.connect();
// A link shows its runs; the first visit shows the newest.
catalogue.start(parsePermalink(location.hash).runs.length === 0);

/** A browser that refuses to keep anything keeps nothing. */
function browserStorage(find: () => Storage): Storage {
  try {
    return find();
  } catch {
    return { getItem: () => null, setItem: () => undefined };
  }
}
