/** An address that leads to something which is not here, or not any more, and the list of what is. */
import { Link } from "react-router-dom";
import styles from "./pages.module.css";

export function NoSuch({ words, list, toList }: { words: string; list: string; toList: string }) {
  return (
    <p role="alert" className={styles.noSuch}>
      {words} <Link to={list}>{toList}</Link>
    </p>
  );
}
