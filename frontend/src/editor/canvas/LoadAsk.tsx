/** The one open question of a pick or drop: what to carry. */
import { useEffect, useRef } from "react";
import { FloatAt } from "./FloatAt";
import type { PixelPoint } from "@/map/plane/paths";
import { useOpenProgram } from "../state/context";
import classes from "./float.module.css";

export interface Load {
  readonly quantity: number | null;
  readonly object: string | null;
}

export function LoadAsk({
  at,
  loads,
  onChoose,
}: {
  at: PixelPoint;
  loads: readonly { quantity: number; object: string }[];
  onChoose: (load: Load) => void;
}) {
  const { t } = useOpenProgram();
  const first = useRef<HTMLButtonElement>(null);
  useEffect(() => first.current?.focus({ preventScroll: true }), []);
  return (
    <FloatAt at={at} dy={14}>
      <div className={classes.ask} role="dialog" aria-label={t("load.title")}>
        <strong>{t("load.title")}</strong>
        <div className={classes.choices}>
          {loads.map((load, index) => (
            <button
              key={`${load.quantity} ${load.object}`}
              ref={index === 0 ? first : undefined}
              type="button"
              className={classes.choice}
              data-first={index === 0 || undefined}
              onClick={() => onChoose(load)}
            >
              {`${load.quantity} × ${load.object}`}
            </button>
          ))}
          <button
            type="button"
            ref={loads.length === 0 ? first : undefined}
            className={classes.choice}
            onClick={() => onChoose({ quantity: null, object: loads[0]?.object ?? null })}
          >
            {t("load.other")}
          </button>
        </div>
      </div>
    </FloatAt>
  );
}
