// The interface of every part of the screen.
import type { Alignment } from '../store/alignment';
import type { CalibrationDesk } from '../store/calibration/calibration_desk';
import type { Cameras } from '../store/pictures/cameras';
import type { PixelProbe } from '../store/pictures/pixel_probe';
import type { PlotTime } from '../store/plots/plot_time';
import type { Store, Topic } from '../store/state';
import type { Player } from '../store/playback/player';
import type { SceneControl } from '../store/scene/scene_control';
import type { ScenarioDesk } from '../store/scenario/scenario_desk';
import type { Sensors } from '../store/sensors/sensors';
import type { Session } from '../store/session';
import type { Catalogue } from '../store/catalogue';
import type { LayoutExchange } from '../store/layouts/layout_exchange';
import type { Layouts } from '../store/layouts/layouts';
import type { MissionDesk } from '../store/missions/mission_desk';
import type { StudyDesk } from '../store/studies/study_desk';
import type { SweepDesk } from '../store/sweeps/sweep_desk';
import type { ReportMaker } from '../store/runs/report_maker';
import type { RestClient } from '../connection/rest_client';
import type { LogBrowser } from '../store/logs/log_browser';
import type { LogSmoothing } from '../store/logs/log_smoothing';
import type { LogWorlds } from '../store/logs/log_worlds';
import type { Themes } from '../store/themes';
import type { TrackColours } from '../store/track_colours';
import type { VehicleConnect } from '../store/vehicle/vehicle_connect';
import type { ScoreDesk } from '../store/scoring/score_desk';
import type { Notices } from '../store/notices';
import type { StreamClient } from '../connection/stream_client';

export interface View {
  readonly root: HTMLElement;
  /** Redraws if one of the changed topics matters to this view. */
  update(changed: ReadonlySet<Topic>): void;
  /** Called when the view is no longer visible: it stops reading what only it shows. */
  onHidden?(): void;
}

/** What views read and call. */
export interface Context {
  store: Store;
  session: Session;
  player: Player;
  scene: SceneControl;
  catalogue: Catalogue;
  scenarios: ScenarioDesk;
  alignment: Alignment;
  cameras: Cameras;
  probe: PixelProbe;
  plotTime: PlotTime;
  sensors: Sensors;
  logs: LogBrowser;
  smoothing: LogSmoothing;
  worlds: LogWorlds;
  connect: VehicleConnect;
  scores: ScoreDesk;
  calibration: CalibrationDesk;
  missions: MissionDesk;
  sweeps: SweepDesk;
  studies: StudyDesk;
  reports: ReportMaker;
  rest: RestClient;
  notices: Notices;
  client: StreamClient;
  layouts: Layouts;
  layoutExchange: LayoutExchange;
  themes: Themes;
  colours: TrackColours;
}
