/** Every screen, with a line at the top while the next one is being loaded. */
import { useTranslation } from "react-i18next";
import { Outlet, useNavigation } from "react-router-dom";
import styles from "./arriving.module.css";

export function Arriving() {
  const { t } = useTranslation();
  const isLoading = useNavigation().state === "loading";
  return (
    <>
      {isLoading ? (
        <div className={styles.line} role="status">
          <span className="visually-hidden">{t("shell.loading")}</span>
        </div>
      ) : null}
      <Outlet />
    </>
  );
}
