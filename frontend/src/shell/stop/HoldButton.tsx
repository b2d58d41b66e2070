/** A button that acts when it has been held for two seconds, by pointer or by Space or Enter. */
import { useEffect, useRef, useState, type KeyboardEvent } from "react";
import styles from "./stop.module.css";

const HOLD_MS = 2000;

interface HoldButtonProps {
  label: string;
  hint: string;
  disabled?: boolean;
  onHeld: () => void;
}

function useHold(onHeld: () => void) {
  const [held, setHeld] = useState(false);
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  const release = () => {
    clearTimeout(timer.current);
    timer.current = undefined;
    setHeld(false);
  };
  const hold = () => {
    if (timer.current !== undefined) return;
    setHeld(true);
    timer.current = setTimeout(() => {
      release();
      onHeld();
    }, HOLD_MS);
  };
  useEffect(() => () => clearTimeout(timer.current), []);
  return { held, hold, release };
}

const isPress = (event: KeyboardEvent) => event.key === " " || event.key === "Enter";

export function HoldButton({ label, hint, disabled, onHeld }: HoldButtonProps) {
  const { held, hold, release } = useHold(onHeld);
  return (
    <button
      type="button"
      className={styles.hold}
      data-held={held || undefined}
      disabled={disabled}
      title={hint}
      onPointerDown={hold}
      onPointerUp={release}
      onPointerLeave={release}
      onBlur={release}
      onContextMenu={(event) => event.preventDefault()}
      onKeyDown={(event) => {
        if (!isPress(event)) return;
        event.preventDefault();
        hold();
      }}
      onKeyUp={(event) => isPress(event) && release()}
    >
      <span>{label}</span>
    </button>
  );
}
