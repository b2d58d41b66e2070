import { useCallback, useEffect, useRef, useState } from "react";
import type { Moment } from "@/scene3d/types";

const REACT_UPDATES_PER_S = 10;

/**
 * The moment of the recording that is shown. `moment` changes with every picture, for what draws itself;
 * `t_s` follows it ten times a second, for what React draws. It begins at `first_s`.
 */
export function useMoment(duration_s: number, first_s = 0) {
  const begins_s = Math.min(Math.max(first_s, 0), duration_s);
  const moment = useRef<Moment>({ t_s: begins_s }).current;
  const [t_s, setT] = useState(begins_s);
  const [playing, setPlaying] = useState(false);
  const [speed, setSpeed] = useState(5);

  const seek = useCallback(
    (to_s: number) => {
      moment.t_s = Math.min(Math.max(to_s, 0), duration_s);
      setT(moment.t_s);
    },
    [moment, duration_s],
  );

  useEffect(() => {
    if (!playing) return;
    let frame = 0;
    let last = performance.now();
    let told = 0;
    const tick = (now: number) => {
      moment.t_s = Math.min(moment.t_s + ((now - last) / 1000) * speed, duration_s);
      last = now;
      if (now - told > 1000 / REACT_UPDATES_PER_S || moment.t_s >= duration_s) {
        told = now;
        setT(moment.t_s);
      }
      if (moment.t_s >= duration_s) setPlaying(false);
      else frame = requestAnimationFrame(tick);
    };
    frame = requestAnimationFrame(tick);
    return () => cancelAnimationFrame(frame);
  }, [playing, speed, duration_s, moment]);

  const toggle = useCallback(() => {
    if (!playing && moment.t_s >= duration_s) seek(0);
    setPlaying(!playing);
  }, [playing, moment, duration_s, seek]);

  return { moment, t_s, playing, speed, seek, toggle, setSpeed, setPlaying };
}
