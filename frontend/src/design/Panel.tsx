import type { ComponentPropsWithRef } from "react";
import styles from "./parts.module.css";

/** A card; `floating` for panels above a canvas. */
export function Panel({ floating, className, ...rest }: ComponentPropsWithRef<"section"> & { floating?: boolean }) {
  return (
    <section
      {...rest}
      className={[styles.panel, className].filter(Boolean).join(" ")}
      data-floating={floating || undefined}
    />
  );
}
