import { Fragment } from "react";
import styles from "./detail.module.css";

/** A topic that goes on in the next line behind a stroke only. */
export function Topic({ topic }: { topic: string }) {
  return (
    <code className={styles.topic}>
      {topic.split(/(?<=\/)/).map((level, index) => (
        <Fragment key={index}>
          {level}
          <wbr />
        </Fragment>
      ))}
    </code>
  );
}
