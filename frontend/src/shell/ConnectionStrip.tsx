/** Says that what is seen may be old, while the site's socket is away. */
import { CloudOff } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useLiveStore } from "@/live/store";
import styles from "./shell.module.css";

export function ConnectionStrip({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const lost = useLiveStore((state) => state.site === slug && state.connection === "reconnecting");
  return (
    <div role="status" className={lost ? styles.strip : "visually-hidden"}>
      {lost ? (
        <>
          <CloudOff size={15} aria-hidden="true" />
          {t("shell.reconnecting")}
        </>
      ) : null}
    </div>
  );
}
