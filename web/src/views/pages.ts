// The pages over the dashboard: the scenario editor, flight logs, scores of trajectories, calibration of a camera,
// missions, sweeps, studies.
import { isLayoutFile } from '../store/layouts/layout_file';
import type { PageOptions } from './page_overlay';
import { PageOverlay } from './page_overlay';
import type { Context, View } from './view';

/** @param behind  what the pages cover */
export function makePages(context: Context, behind: readonly HTMLElement[]): View[] {
  const pages: PageOptions[] = [
    {
      name: 'scenario',
      topic: 'launch',
      page: ({ scenarioEditor }) => scenarioEditor,
      load: async (owner) => new (await import('./scenario/scenario_page')).ScenarioPageView(owner),
    },
    {
      name: 'logs',
      topic: 'logs',
      page: ({ logPage }) => logPage,
      load: async (owner) => new (await import('./logs/log_page')).LogPageView(owner),
    },
    {
      name: 'scoring',
      topic: 'scoring',
      page: ({ scorePage }) => scorePage,
      load: async (owner) => new (await import('./scoring/score_page')).ScorePageView(owner),
    },
    {
      name: 'calibration',
      topic: 'calibration',
      page: ({ calibrationPage }) => calibrationPage,
      load: async (owner) =>
        new (await import('./calibration/calibration_page')).CalibrationPageView(owner),
    },
    {
      name: 'missions',
      topic: 'missions',
      page: ({ missionPage }) => missionPage,
      load: async (owner) => new (await import('./missions/mission_page')).MissionPageView(owner),
    },
    {
      name: 'sweeps',
      topic: 'sweeps',
      page: ({ sweepPage }) => sweepPage,
      load: async (owner) => new (await import('./sweeps/sweep_page')).SweepPageView(owner),
    },
    {
      name: 'studies',
      topic: 'studies',
      page: ({ studyPage }) => studyPage,
      load: async (owner) => new (await import('./studies/study_page')).StudyPageView(owner),
    },
  ];
  return pages.map((page) => new PageOverlay(context, page, behind));
}

/**
 * Files dropped anywhere are read: as missions where those are drawn, as images where a camera is
 * calibrated, as trajectories where those are scored, else as layouts or logs.
 */
export function acceptFiles(context: Context): void {
  const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') === true;
  document.addEventListener('dragover', (event) => {
    if (hasFiles(event)) event.preventDefault();
  });
  document.addEventListener('drop', (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length === 0) return;
    const { scorePage, calibrationPage, missionPage, topPage } = context.store.state;
    if (topPage === missionPage && files[0] !== undefined) void context.missions.import(files[0]);
    else if (topPage === calibrationPage) upload(context, () => context.calibration.send(files));
    else if (topPage === scorePage) upload(context, () => context.scores.send(files));
    else void acceptLayoutOrLogs(context, files);
  });
}

async function acceptLayoutOrLogs(context: Context, files: File[]): Promise<void> {
  const [only] = files;
  if (only !== undefined && files.length === 1 && (await isLayoutFile(only))) {
    await context.layoutExchange.import(only);
    return;
  }
  upload(context, async () => {
    await context.logs.open();
    await context.logs.send(files);
  });
}

/** Layouts and missions of files stay in the browser; all else goes to the server. */
function upload({ notices, store }: Context, send: () => Promise<void>): void {
  if (store.state.mayChange) void send();
  else notices.error("Uploading needs the operator's address.");
}
