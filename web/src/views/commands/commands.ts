// Everything that the command palette offers.
import type { Command } from '../../store/palette';
import { failedEstimators } from '../../store/studies/study_form';
import { kPanelNames, kPanels } from '../../store/layouts/panel_names';
import { kReadyLayouts } from '../../store/layouts/ready_layouts';
import { withResults } from '../../store/runs/counted_results';
import { kSceneParts } from '../../store/scene/scene_look';
import { kThemes, kThemeTitles } from '../../store/themes';
import { kTimeCommands } from '../plots/time_commands';
import { kShortcuts } from './shortcuts';
import { saveReport } from '../runs/report_button';
import { prepareStudy } from '../studies/prepare_study';
import type { Context } from '../view';

const kMostListed = 500;

export function commandsOf(context: Context): Command[] {
  const { mayChange } = context.store.state;
  return allCommands(context).filter(({ changes }) => mayChange || changes !== true);
}

function allCommands(context: Context): Command[] {
  return [
    ...layoutCommands(context),
    ...panelCommands(context),
    ...sceneCommands(context),
    ...plotCommands(context),
    ...themeCommands(context),
    ...shortcutCommands(context),
    ...pageCommands(context),
    ...launchCommands(context),
    ...reportCommands(context),
    ...studyCommands(context),
    ...runCommands(context),
  ];
}

function layoutCommands({ layouts }: Context): Command[] {
  const ready = kReadyLayouts.map(({ name, title, hint }) => ({
    id: `layout ${name}`,
    group: 'Layout',
    title,
    words: hint,
    run: () => layouts.choose(name),
  }));
  const own = layouts.ownNames.map((name) => ({
    id: `own layout ${name}`,
    group: 'Own layout',
    title: name,
    run: () => layouts.choose(name),
  }));
  const reset = {
    id: 'reset layout',
    group: 'Layout',
    title: 'Undo my changes of this layout',
    words: 'reset',
    run: () => layouts.reset(),
  };
  return [...ready, ...own, ...(layouts.isChanged ? [reset] : [])];
}

function panelCommands({ layouts }: Context): Command[] {
  const show = kPanelNames.map((name) => ({
    id: `show ${name}`,
    group: 'Panel',
    title: `Show ${kPanels[name].title}`,
    words: kPanels[name].hint,
    run: () => layouts.show(name),
  }));
  const hide = layouts.panels().map((name) => ({
    id: `hide ${name}`,
    group: 'Panel',
    title: `Hide ${kPanels[name].title}`,
    run: () => layouts.hide(name),
  }));
  return [...show, ...hide];
}

function sceneCommands({ scene, store }: Context): Command[] {
  return kSceneParts.map(({ part, label, hint }) => ({
    id: `scene ${part}`,
    group: '3D view',
    title: `${store.state.scene.show.has(part) ? 'Hide' : 'Show'} ${label.toLowerCase()}`,
    words: hint,
    run: () => scene.togglePart(part),
  }));
}

function plotCommands({ plotTime }: Context): Command[] {
  return kTimeCommands.map(({ title, run }) => ({
    id: title,
    group: 'Plots',
    title,
    words: 'over time pan move zoom',
    run: () => run(plotTime),
  }));
}

function themeCommands({ themes }: Context): Command[] {
  return kThemes.map((theme) => ({
    id: `theme ${theme}`,
    group: 'Theme',
    title: kThemeTitles[theme],
    words: 'colours',
    run: () => themes.choose(theme),
  }));
}

function shortcutCommands(context: Context): Command[] {
  return kShortcuts
    .filter(({ keys }) => !keys.includes('escape'))
    .map(({ label, what, run }) => ({
      id: `key ${label}`,
      group: 'Key',
      title: `${what.charAt(0).toUpperCase()}${what.slice(1)}`,
      keys: label,
      run: () => run(context),
    }));
}

function pageCommands({ calibration, missions, scores, studies, sweeps }: Context): Command[] {
  const group = 'Page';
  return [
    {
      id: 'missions',
      group,
      title: 'Missions on a map',
      words: 'draw plan waypoints qgroundcontrol',
      run: () => void missions.open(),
    },
    {
      id: 'sweeps',
      group,
      title: 'Sweeps of many flights',
      words: 'matrix table experiment success rate envelope',
      run: () => void sweeps.open(),
    },
    {
      id: 'studies',
      group,
      title: 'Studies: causes, risks, worst flights',
      words: 'explain predict hunt failure results',
      run: () => void studies.open(),
    },
    {
      id: 'scoring',
      group,
      title: 'Score trajectories',
      words: 'evaluate upload file plot',
      run: () => void scores.open(),
    },
    {
      id: 'calibration',
      group,
      title: 'Calibrate a camera',
      words: 'intrinsics distortion chequerboard charuco lens',
      run: () => void calibration.open(),
    },
  ];
}

/** Of the launcher. */
function launchCommands({ connect, logs, scenarios, store }: Context): Command[] {
  const group = 'Page';
  const logsTitle = store.state.mayChange ? 'Fly a log' : 'Flight logs';
  return [
    { id: 'logs', group, title: logsTitle, words: 'upload', run: () => void logs.open() },
    {
      id: 'connect',
      group,
      title: 'Connect to an autopilot',
      changes: true,
      run: () => connect.open(),
    },
    {
      id: 'editor',
      group,
      title: 'Edit the scenario',
      words: 'form json camera estimator parameters save',
      run: () => void scenarios.openEditor(),
    },
  ];
}

function reportCommands(context: Context): Command[] {
  if (context.reports.runs().length === 0) return [];
  return [
    {
      id: 'report',
      group: 'Run',
      title: 'Save a report of the shown runs',
      words: 'export html file figures tables pdf',
      run: () => void saveReport(context),
    },
  ];
}

function studyCommands(context: Context): Command[] {
  const { store, studies } = context;
  const group = 'Study';
  const run = withResults(store.state.main);
  const failed = run !== null && failedEstimators(run).length > 0;
  return [
    ...(failed
      ? [
          {
            id: 'explain run',
            group,
            title: `Explain why ${failedEstimators(run).join(', ')} failed`,
            words: 'cause reason lost',
            changes: true as const,
            run: () => void studies.explain(run),
          },
        ]
      : []),
    {
      id: 'predict',
      group,
      title: 'Predict where the scenario is risky',
      words: 'risk before flight map',
      changes: true,
      run: () => prepareStudy(context, 'predict'),
    },
    {
      id: 'hunt',
      group,
      title: 'Hunt the worst flight of the scenario',
      words: 'search failure limits',
      changes: true,
      run: () => prepareStudy(context, 'hunt'),
    },
  ];
}

function runCommands({ session, store }: Context): Command[] {
  return (store.state.runs ?? []).slice(0, kMostListed).map(({ id, title, scenario, status }) => ({
    id: `run ${id}`,
    group: 'Open run',
    title: title || scenario,
    words: `${id} ${scenario} ${status}`,
    keys: id.slice(0, 15),
    run: () => session.selectRun(id),
  }));
}
