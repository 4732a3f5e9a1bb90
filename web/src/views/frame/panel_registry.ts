// Makes the panels. Their names and titles are in store/layouts/panel_names.ts.
import { CameraPanel } from '../pictures/camera_panel';
import { ErrorPanel } from '../status/error_panel';
import { Launcher } from '../launcher';
import { LogPanel } from '../status/log_panel';
import { DebugPanel } from '../pictures/debug_panel';
import { PlotsPanel } from '../plots/plots_panel';
import { RunList } from '../runs/run_list';
import { ScenePanel } from '../scene/scene_panel';
import { VehicleCard } from '../vehicle/vehicle_card';
import type { PanelName } from '../../store/layouts/panel_names';
import type { Context, View } from '../view';

/** Panels outside the default layout are loaded when they are first shown. */
export const kPanelMakers: Record<PanelName, (context: Context) => View | Promise<View>> = {
  launcher: (context) => new Launcher(context),
  runs: (context) => new RunList(context),
  log: (context) => new LogPanel(context),
  scene: (context) => withVehicle(new ScenePanel(context), new VehicleCard(context)),
  plots: (context) => new PlotsPanel(context),
  'plots-errors': (context) => new PlotsPanel(context, 'errors'),
  'plots-image': (context) => new PlotsPanel(context, 'image'),
  plot3d: async (context) => {
    const { Plot3dPanel } = await import('../plot3d/plot3d_panel');
    return new Plot3dPanel(context);
  },
  camera: (context) => new CameraPanel(context),
  debug: (context) => new DebugPanel(context),
  depth: async (context) => {
    const { DepthPanel } = await import('../pictures/depth_panel');
    return new DepthPanel(context);
  },
  'image-error': async (context) => {
    const { ImageErrorPanel } = await import('../pictures/image_error_panel');
    return new ImageErrorPanel(context);
  },
  errors: (context) => new ErrorPanel(context),
  differences: async (context) => {
    const { DifferencesPanel } = await import('../runs/differences_panel');
    return new DifferencesPanel(context);
  },
  repeats: async (context) => {
    const { RepeatsPanel } = await import('../runs/repeats_panel');
    return new RepeatsPanel(context);
  },
  status: async (context) => {
    const { StatusPanel } = await import('../status/status_panel');
    return new StatusPanel(context);
  },
};

function withVehicle(scene: ScenePanel, vehicle: VehicleCard): View {
  scene.root.querySelector('.panel-body')?.append(vehicle.root);
  return {
    root: scene.root,
    update(changed) {
      scene.update(changed);
      vehicle.update(changed);
    },
    onHidden: () => scene.onHidden(),
  };
}
