// Keyboard shortcuts, active unless text is being typed.
import type { Context } from '../view';

interface Shortcut {
  /** KeyboardEvent.key values, lower case, after "ctrl+" and "shift+" for keys that are held. */
  keys: readonly string[];
  label: string;
  what: string;
  /** Steers nothing that a page covers. */
  overPages?: true;
  run: (context: Context) => void;
}

const kSecond_ns = 1e9;

export const kShortcuts: readonly Shortcut[] = [
  {
    keys: [' '],
    label: 'Space',
    what: 'play or pause',
    run: ({ player }) => player.togglePlay(),
  },
  {
    keys: ['arrowleft'],
    label: '←',
    what: 'one frame back',
    run: ({ player }) => player.step(-1),
  },
  {
    keys: ['arrowright'],
    label: '→',
    what: 'one frame forward',
    run: ({ player }) => player.step(1),
  },
  {
    keys: ['shift+arrowleft'],
    label: 'Shift ←',
    what: 'one second back',
    run: ({ player }) => player.seekBy(-kSecond_ns),
  },
  {
    keys: ['shift+arrowright'],
    label: 'Shift →',
    what: 'one second forward',
    run: ({ player }) => player.seekBy(kSecond_ns),
  },
  {
    keys: ['home'],
    label: 'Home',
    what: 'to the start',
    run: ({ player }) => player.seekEdge('begin'),
  },
  {
    keys: ['end'],
    label: 'End',
    what: 'to the end',
    run: ({ player }) => player.seekEdge('end'),
  },
  {
    keys: ['+', 'shift++', '='],
    label: '+',
    what: 'faster',
    run: ({ player }) => player.changeSpeed(1),
  },
  { keys: ['-'], label: '−', what: 'slower', run: ({ player }) => player.changeSpeed(-1) },
  {
    keys: ['r'],
    label: 'R',
    what: 'backwards or forwards',
    run: ({ player }) => player.reverse(),
  },
  {
    keys: ['['],
    label: '[',
    what: 'play from here',
    run: ({ player }) => player.setRangeEnd('begin'),
  },
  {
    keys: [']'],
    label: ']',
    what: 'play to here',
    run: ({ player }) => player.setRangeEnd('end'),
  },
  {
    keys: ['\\'],
    label: '\\',
    what: 'play everything again',
    run: ({ player }) => player.clearRange(),
  },
  {
    keys: ['1'],
    label: '1',
    what: 'chase view',
    run: ({ scene }) => scene.setMode('chase'),
  },
  {
    keys: ['2'],
    label: '2',
    what: 'orbit view',
    run: ({ scene }) => scene.setMode('orbit'),
  },
  { keys: ['3'], label: '3', what: 'top view', run: ({ scene }) => scene.setMode('top') },
  {
    keys: ['4'],
    label: '4',
    what: 'view from the cockpit',
    run: ({ scene }) => scene.setMode('onboard'),
  },
  { keys: ['5'], label: '5', what: 'free flight', run: ({ scene }) => scene.setMode('free') },
  {
    keys: ['i'],
    label: 'I',
    what: "camera's image on the ground in 3D",
    run: ({ scene }) => scene.togglePart('image'),
  },
  {
    keys: ['f'],
    label: 'F',
    what: 'toggle following the aircraft',
    run: ({ scene }) => scene.toggleFollow(),
  },
  {
    keys: ['l'],
    label: 'L',
    what: 'follow the running flight',
    run: ({ player }) => player.goLive(),
  },
  {
    keys: ['ctrl+k'],
    label: 'Ctrl K',
    what: 'every command by name',
    overPages: true,
    run: ({ store }) => store.setPaletteOpen(true),
  },
  {
    keys: ['t'],
    label: 'T',
    what: 'next theme',
    overPages: true,
    run: ({ themes }) => themes.next(),
  },
  {
    keys: ['?', 'shift+?'],
    label: '?',
    what: 'this help',
    overPages: true,
    run: ({ store }) => toggleHelp(store),
  },
  {
    keys: ['escape'],
    label: 'Esc',
    what: 'close, restore',
    overPages: true,
    run: (context) => closeTopmost(context),
  },
];

export function listenToKeys(context: Context): void {
  document.addEventListener('keydown', (event) => {
    if (event.altKey || (wantsKey(event) && !isCommand(event))) return;
    const held = (isCommand(event) ? 'ctrl+' : '') + (event.shiftKey ? 'shift+' : '');
    const name = held + event.key.toLowerCase();
    const shortcut = kShortcuts.find(({ keys }) => keys.includes(name));
    if (shortcut === undefined) return;
    if (context.store.state.covered && shortcut.overPages !== true) return;
    event.preventDefault();
    shortcut.run(context);
  });
  leaveAfterMouse();
}

/** Ctrl, or the command key of a Mac. */
function isCommand({ ctrlKey, metaKey }: KeyboardEvent): boolean {
  return ctrlKey || metaKey;
}

/** Whether the focused element needs the key itself. */
function wantsKey({ target, key }: KeyboardEvent): boolean {
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLInputElement && target.type !== 'checkbox') return true;
  return key === ' ' && (target instanceof HTMLButtonElement || target instanceof HTMLInputElement);
}

/** A control used with the mouse loses the focus, so that the shortcuts work again. */
function leaveAfterMouse(): void {
  let mouse = false;
  document.addEventListener('pointerdown', () => (mouse = true), true);
  document.addEventListener('keydown', () => (mouse = false), true);
  const leave = ({ target }: Event) => {
    if (mouse && (target instanceof HTMLSelectElement || target instanceof HTMLButtonElement)) {
      target.blur();
    }
  };
  document.addEventListener('change', leave);
  document.addEventListener('click', ({ target }) => {
    const button = target instanceof Element ? target.closest('button') : null;
    if (!mouse || button === null) return;
    // One that was made again by its click has a successor with the focus.
    const used = button.isConnected ? button : document.activeElement;
    if (used instanceof HTMLButtonElement) used.blur();
  });
}

function toggleHelp(store: Context['store']): void {
  store.state.helpOpen = !store.state.helpOpen;
  store.change('help');
}

/** Closes what lies over everything else; if nothing does, restores an enlarged panel. */
export function closeTopmost(context: Context): void {
  const { store, connect, layouts } = context;
  const { state } = store;
  if (state.helpOpen) {
    toggleHelp(store);
  } else if (state.paletteOpen) {
    store.setPaletteOpen(false);
  } else if (state.connect.open) {
    connect.close();
  } else if (state.topPage !== null) {
    deskOf(context, state.topPage)?.close();
  } else {
    layouts.restore();
  }
}

/** What closes a page also ends what only the page needs. */
function deskOf(context: Context, page: { open: boolean }): { close(): void } | undefined {
  const { state } = context.store;
  const desks = new Map<{ open: boolean }, { close(): void }>([
    [state.scenarioEditor, context.scenarios],
    [state.logPage, context.logs],
    [state.scorePage, context.scores],
    [state.calibrationPage, context.calibration],
    [state.missionPage, context.missions],
    [state.sweepPage, context.sweeps],
    [state.studyPage, context.studies],
  ]);
  return desks.get(page);
}
