/** One of a few ways to look at something: buttons side by side that lie over a picture, chosen by arrow keys, too. */
import { SegmentedControl } from "@mantine/core";
import type { LucideIcon } from "lucide-react";
import styles from "./segments.module.css";

export interface Segment<Value extends string> {
  readonly value: Value;
  readonly words: string;
  readonly icon: LucideIcon;
}

interface SegmentsProps<Value extends string> {
  label: string;
  segments: readonly Segment<Value>[];
  value: Value;
  choose: (value: Value) => void;
}

export function Segments<Value extends string>({ label, segments, value, choose }: SegmentsProps<Value>) {
  return (
    <SegmentedControl
      aria-label={label}
      classNames={{ root: styles.root ?? "", indicator: styles.indicator ?? "", label: styles.label ?? "" }}
      value={value}
      onChange={choose}
      data={segments.map(({ value: each, words, icon: Icon }) => ({
        value: each,
        label: (
          <span className={styles.words}>
            <Icon size={15} aria-hidden="true" /> {words}
          </span>
        ),
      }))}
    />
  );
}
