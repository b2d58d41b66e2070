/** Says that what is seen may be old, while the site's socket is away, and why it stays away. */
import { CloudOff } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useLiveStore } from "@/live/store";
import styles from "./shell.module.css";

const TOLD = ["reconnecting", "crowded", "refused"] as const;

export function ConnectionStrip({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const told = useLiveStore((state) => TOLD.find((each) => state.site === slug && state.connection === each));
  return (
    <div role="status" className={told ? styles.strip : "visually-hidden"}>
      {told ? (
        <>
          <CloudOff size={15} aria-hidden="true" />
          {t(`shell.${told}`)}
        </>
      ) : null}
    </div>
  );
}
