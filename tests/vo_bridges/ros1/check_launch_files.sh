#!/usr/bin/env bash
# Every launch file is read by roslaunch itself, and every preset sets what it is named for.
# Usage: check_launch_files.sh FOLDER. Exit code 77 where roslaunch is not installed.
set -euo pipefail
folder=$1
command -v roslaunch >/dev/null || { echo "skipped: roslaunch is not installed"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
export ROS_LOG_DIR=$scratch ROS_HOME=$scratch ROS_MASTER_URI=http://127.0.0.1:1

# FILE ARGUMENTS... -- LINES that must be among the parameters
expect() {
  local arguments=() dump
  while [ "$1" != -- ]; do arguments+=("$1"); shift; done
  shift
  dump=$(roslaunch --dump-params "$folder/${arguments[0]}" "${arguments[@]:1}")
  for line in "$@" "/use_sim_time: true"; do
    grep -qxF "$line" <<<"$dump" || { echo "${arguments[*]}: lacks '$line' in"; echo "$dump"; exit 1; }
  done
}

expect orb_slam2.launch -- "/orb_slam2_mono/ORBextractor/minThFAST: 7" \
  "/orb_slam2_mono/ORBextractor/iniThFAST: 20" "/orb_slam2_mono/load_calibration_from_cam: true"
expect orb_slam2.launch preset:=low_texture -- "/orb_slam2_mono/ORBextractor/minThFAST: 2"
expect svo.launch -- "/svo/triang_min_corner_score: 20.0" "/svo/kfselect_mindist: 0.12" \
  "/svo/cam_fx: 700.006" "/svo/cam_cx: 639.5" "/svo/publish_world_in_cam_frame: true"
expect svo.launch preset:=corner_7 -- "/svo/triang_min_corner_score: 7.0"
expect svo.launch preset:=corner_2 -- "/svo/triang_min_corner_score: 2.0"
expect svo.launch preset:=keyframes_5 -- "/svo/kfselect_mindist: 0.05"
expect dso.launch calib:=camera.txt --
echo "all launch files are read"
