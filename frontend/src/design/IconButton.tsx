import { Tooltip } from "@mantine/core";
import type { ComponentPropsWithRef } from "react";
import styles from "./parts.module.css";

interface IconButtonProps extends ComponentPropsWithRef<"button"> {
  /** What it does: read aloud, and shown on hover. */
  label: string;
}

/** A button that is only an icon; never without its words. */
export function IconButton({ label, className, children, ...rest }: IconButtonProps) {
  return (
    <Tooltip label={label}>
      <button type="button" {...rest} aria-label={label} className={[styles.icon, className].filter(Boolean).join(" ")}>
        {children}
      </button>
    </Tooltip>
  );
}
